"""Mass-spring models of elastic solids, proved against finite elements.

    import springproof as sp
    bar = sp.block(size=(0.06, 0.01, 0.01), cells=(24, 4, 4))                       # [m]
    model = sp.Model("hybmss_avg", bar, sp.Material(E=1e6, nu=0.49, density=1100))  # [Pa], [kg/m^3]
    state = model.solve([sp.Displacement("x_min"), sp.Force("x_max", (0, 0, -0.005))])
    print(state.at([(0.06, 0.005, 0.005)]))                                         # [m]

SI units throughout.  docs/python.md has the table of functions.
"""

import sys as _sys

try:
    from . import _springproof as _compiled  # noqa: F401
except ImportError as _error:
    raise ImportError(
        f"springproof: its compiled part is not beside it, or is of another Python than {_sys.executable} ({_error}); at the top of the "
        "repository: ./quickstart.sh python, and what that prints; or pip install --no-build-isolation ."
    ) from _error

from ._compare import compare, find_program, identify
from ._springproof import (
    Body,
    Displacement,
    Force,
    Gravity,
    InputError,
    Mass,
    Material,
    Model,
    Motion,
    Patch,
    PointForce,
    Pressure,
    Region,
    Rotation,
    SolveError,
    State,
    Traction,
    block,
    homogenise,
    measure_moduli,
    models,
    voxels,
    write_pvd,
    write_vtu,
)
from ._springs import read_springs

__all__ = [name for name in dir() if not name.startswith("_")]

for _name in __all__:
    if hasattr(globals()[_name], "__module__"):
        globals()[_name].__module__ = __name__
