"""Bodies of several materials."""
import numpy as np
import pytest
import springproof as sp

HELD, PULLED = (0, 0, 0.002), (0, 0, 0.018)
CORE = ((0.011, 0.01, 0.0105), 0.005)
CASE = {
    "name": "core",
    "body": {"geo": "sphere.geo", "size_m": [0.02, 0.02, 0.02], "voxel_edge_m": 0.0025},
    "material": {"youngs_modulus_Pa": 1e4, "poisson_ratio": 0.4, "density_kg_m3": 1100},
    "region": [{"name": "core", "near": {"point_m": CORE[0], "radius_m": CORE[1]}, "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3, "density_kg_m3": 3000}],
    "patch": [{"name": "low", "beyond": {"point_m": HELD, "normal": [0, 0, -1]}}, {"name": "high", "beyond": {"point_m": PULLED, "normal": [0, 0, 1]}}],
    "load": [{"on": "low", "displacement_m": [0, 0, 0]}, {"on": "high", "force_N": [0, 0.01, 0.02]}],
    "probe": [{"name": "P", "at_m": [0.012, 0.009, 0.015]}],
    "compare": {"models": ["hybmss_avg"], "measures": ["probe", "reaction"]},
    "reference": {"elements": []},
}


def body_of(**place):
    region = sp.Region("core", sp.Material(1e6, 0.3, density=3000), **place)
    patches = [sp.Patch("low", beyond=(HELD, (0, 0, -1))), sp.Patch("high", beyond=(PULLED, (0, 0, 1)))]
    return sp.voxels("sphere.geo", edge=0.0025, size=(0.02, 0.02, 0.02), patches=patches, regions=[region])


@pytest.mark.parametrize("name, options", [("hybmss_avg", {"cut": True, "held": ["low"]}), ("hybmss", {})])
def test_they_move_as_compare_says(name, options):
    model = sp.Model(name, body_of(near=CORE), sp.Material(1e4, 0.4, density=1100), **options)
    assert set(model.cell_materials) == {0, 1}
    ball = 4 / 3 * np.pi
    assert model.masses.sum() == pytest.approx(ball * (1100 * 0.01**3 + 1900 * CORE[1] ** 3), rel=0.02 if options else 0.1)
    state = model.solve([sp.Displacement("low"), sp.Force("high", (0, 0.01, 0.02))])
    if not sp.find_program():
        pytest.skip("no program springproof")
    choice = {"model": name, "label": "mine", "cut": "cut" in options}
    compared = sp.compare(CASE | {"compare": CASE["compare"] | {"models": [choice]}})
    rows = {row["measure"]: row["value"] for row in compared if row["model"] == "mine"}
    wanted = [rows[f"displacement.P.{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(state.at([(0.012, 0.009, 0.015)])[0], wanted, rtol=1e-6, atol=1e-9 * np.abs(wanted).max())


def test_what_is_not_possible_is_said():
    with pytest.raises(sp.InputError, match="'core' needs one place"):
        body_of()
    with pytest.raises(sp.InputError, match="holds no part of the body"):
        body_of(near=((1, 1, 1), 0.1))
    with pytest.raises(sp.InputError, match="one material here .allowed for a body of regions: lattices of cells"):
        sp.Model("emsm", body_of(near=CORE), sp.Material(1e4, 0.4))
