"""Builds the Python package: CMake configures without finite elements and builds one target.

SPRINGPROOF_BUILD names a CMake build tree that exists; what is built there is not built again.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent
TARGET = "springproof-python"


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        file = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        tree = pathlib.Path(os.environ.get("SPRINGPROOF_BUILD") or pathlib.Path(self.build_temp).resolve() / "cmake")
        if not (tree / "CMakeCache.txt").is_file():
            generator = ["-G", "Ninja"] if shutil.which("ninja") else []
            subprocess.run(
                ["cmake", "-S", SOURCE, "-B", tree, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                 "-DSPRINGPROOF_FEM=OFF", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", tree, "--target", TARGET, "--parallel", str(os.cpu_count() or 1)], check=True)
        built = tree / "python" / "springproof" / file.name
        if not built.is_file():
            raise SystemExit(f"{tree} builds no {file.name}; it is of another Python (allowed: a build tree of {sys.executable})")
        file.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(built, file)
        shutil.copyfile(SOURCE / "examples" / "springs.py", file.parent / "springs.py")
        # The built-in bodies, which voxels() finds beside the package.
        shutil.copytree(SOURCE / "meshes" / "geo", file.parent / "geo", dirs_exist_ok=True)


version = re.search(r"project\(springproof VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
setup(version=version, ext_modules=[Extension("springproof._springproof", [])], cmdclass={"build_ext": CMakeBuild})
