# SPDX-License-Identifier: Apache-2.0
"""The report's own Python environment, made on the first run, and the libraries that its packages look for."""
import glob
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = ("numpy", "matplotlib", "mitsuba", "pyradiance")
FOLDER = ROOT / "build" / "report-venv"


def enter():
    """Runs this program again inside the environment, unless it is there already."""
    if pathlib.Path(sys.prefix).resolve() == FOLDER.resolve():
        return
    python, complete = FOLDER / "bin" / "python", FOLDER / "complete"
    wanted = "\n".join(PACKAGES) + "\n"
    if not complete.exists() or complete.read_text() != wanted:
        print(f"Making {FOLDER} with {', '.join(PACKAGES)} (once; needs the network)", flush=True)
        made = subprocess.run([sys.executable, "-m", "venv", str(FOLDER)])
        if made.returncode:
            sys.exit("report: python3 -m venv failed: install the package python3-venv")
        if subprocess.run([str(python), "-m", "pip", "install", "--quiet", *PACKAGES]).returncode:
            sys.exit(f"report: {', '.join(PACKAGES)} cannot be installed from PyPI; see above")
        complete.write_text(wanted)
    os.execv(python, [str(python), *sys.argv])


def find_llvm():
    """Tells Dr.Jit, on which Mitsuba runs, which LLVM to load, unless the user has. Returns its path or None.

    Dr.Jit 1.5 refuses LLVM 14 and aborts with 15 and 16 on AVX-512; 19 is known to work."""
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        found = [path for version in (19, 18, 17, 20, 21)
                 for path in sorted(glob.glob(f"/usr/lib/*/libLLVM-{version}.so*"))]
        if found:
            os.environ["DRJIT_LIBLLVM_PATH"] = found[0]
    return os.environ.get("DRJIT_LIBLLVM_PATH")


def use_software_driver():
    """Pins Mesa's lavapipe, as tools/test does, unless the user chose a driver."""
    drivers = sorted(glob.glob("/usr/share/vulkan/icd.d/lvp_icd*.json"))
    if drivers and "VK_ICD_FILENAMES" not in os.environ and "VK_DRIVER_FILES" not in os.environ:
        os.environ["VK_ICD_FILENAMES"] = drivers[-1]


def facts():
    """What a reader must know of machine and sources to judge times."""
    def first_line(command):
        try:
            return subprocess.run(command, capture_output=True, text=True, cwd=ROOT).stdout.strip().split("\n")[0]
        except OSError:
            return ""
    model = ""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    changed = bool(first_line(["git", "status", "--porcelain", "--untracked-files=no"]))
    return {"commit": first_line(["git", "rev-parse", "--short=12", "HEAD"]), "uncommitted_changes": changed,
            "processor": model, "cores": os.cpu_count(), "load_average_at_start": os.getloadavg()}
