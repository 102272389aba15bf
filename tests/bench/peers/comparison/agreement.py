"""That contenders compute the same thing, before they are timed."""

import subprocess

import numpy as np

# Rounding of binary32 on a mesh and of an influence function, relative to the rms of what is compared.
TOLERANCE = 1e-4


class Disagreement(Exception):
    """Two contenders computed different things."""


def deviation(mine, reference):
    """Rms of the difference over the rms of the reference."""
    return float(np.sqrt(np.mean(np.square(mine - reference)) / np.mean(np.square(reference))))


def hold(label, mine, reference):
    if mine.shape != reference.shape:
        raise Disagreement(f"{label} has values of shape {mine.shape}, expected {reference.shape}")
    found = deviation(mine, reference)
    if not found <= TOLERANCE:
        raise Disagreement(f"{label} differs by {found:.1e} of the rms, more than {TOLERANCE:.0e}")
    return found


def of_fields(running):
    """The fields of all contenders at some nodes against those of the first; the largest deviation."""
    if not running:
        raise Disagreement("none of the contenders could be started: there is nothing to compare")
    reference, *others = (np.array(each.ask("check")) for each in running)
    return max((hold(each.label, mine, reference) for each, mine in zip(running[1:], others)), default=0.0)


def of_forces(rows, state):
    """The script's forces against those of this engine with the paper's scheme, for one state."""
    ours, theirs = (rows.peers / f"forces-{whose}.csv" for whose in ("ours", "theirs"))
    positions = rows.state(state)
    command = [rows.program, "forces", "table-1", "--set", "force.method=pm", "--positions", positions, "--out", ours]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    script = rows.script("forces", positions, str(theirs))
    subprocess.run(["env", *(f"{key}={value}" for key, value in script.environment), *script.command], check=True)
    reference = np.loadtxt(ours, delimiter=",", skiprows=1, usecols=(3, 4))
    return hold(f"the script's force, {state},", np.loadtxt(theirs, delimiter=","), reference)
