// The engine in JavaScript: 200 discs of a stored state go on attracting each other, and the digest is printed.
//
// `./run-example` builds the module and runs this in node. In a browser, replace the two calls of readFile by
// `await (await fetch(address)).arrayBuffer()`; the rest is the same.
//
// usage: node example.mjs example.wasm start.state

import { readFile } from "node:fs/promises";
import { argv, exit } from "node:process";

const SIDE = 64; // R0
const { instance } = await WebAssembly.instantiate(await readFile(argv[2]));
const engine = instance.exports;

// A state file: 8 bytes of magic, format version and number of discs, step and time, then all x and all y.
const file = await readFile(argv[3]);
const state = new DataView(file.buffer, file.byteOffset, file.byteLength);
const count = state.getUint32(12, true);
if (count > engine.capacity()) {
  console.error(`${count} discs, but room for ${engine.capacity()}`);
  exit(1);
}

// The array the module shares: x and y of each disc as fractions of the box, unit L·2⁻³². Its memory never grows, so that
// this view of it stays valid.
const discs = new Uint32Array(engine.memory.buffer, engine.discs(), 2 * count);
for (let id = 0; id < count; id++) {
  discs[2 * id] = state.getUint32(32 + 4 * id, true);
  discs[2 * id + 1] = state.getUint32(32 + 4 * (count + id), true);
}

// V0 = 20 kBT, λ = 40 R0, seed 1.
if (engine.start(count, SIDE, 20, 40, 1n) !== 0) {
  console.error("the engine refused the start");
  exit(1);
}
for (let done = 0; done < 300; done += 100) {
  if (engine.step(100) !== 0) {
    console.error("the engine refused a step");
    exit(1);
  }
  const place = Array.from(discs.subarray(0, 2), (bits) => ((bits / 2 ** 32) * SIDE).toFixed(3));
  console.log(`time ${engine.time().toFixed(6)} R0²/D, disc 0 at (${place.join(", ")}) R0`);
}
const digest = new Uint8Array(engine.memory.buffer, engine.digest(), 32);
console.log(Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join(""));
