// Runs all golden cases of a WebAssembly module in node and prints their lines.
//
// usage: node host.mjs cases.wasm

import { readFile } from "node:fs/promises";
import { argv, exit, stdout } from "node:process";

// No imports: the core does no input or output.
const { instance } = await WebAssembly.instantiate(await readFile(argv[2]));
const { memory, run_all, output_address, output_length } = instance.exports;

const failed = run_all();
const text = Buffer.from(memory.buffer, output_address(), output_length());
stdout.write(text, () => exit(failed));
