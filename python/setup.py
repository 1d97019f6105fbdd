"""Makes the wheel of the package and of the module that `./softland python` builds, for machines with the same processor and Debian packages."""

import shutil
import subprocess
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[1]
SCRATCH = ROOT / "build" / "wheel"  # outside of the sources, whose changes the launcher detects
SCRATCH.mkdir(parents=True, exist_ok=True)


class Built(build_ext):
    """Copies the module from the build folder, which the launcher names."""

    def build_extension(self, ext):
        line = subprocess.run([ROOT / "softland", "python"], check=True, stdout=subprocess.PIPE, text=True).stdout
        folder = Path(line.split("=", 1)[1].split("${")[0].strip().strip("'"))
        (module,) = (folder / "softland").glob("_softland.*.so")
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(module, target)
        shutil.copy2(folder / "softland" / "_studies.py", target.with_name("_studies.py"))


setup(
    packages=["softland"],
    package_data={"softland": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("softland._softland", [])],
    cmdclass={"build_ext": Built},
    options={"build": {"build_base": str(SCRATCH)}, "egg_info": {"egg_base": str(SCRATCH)}},
)
