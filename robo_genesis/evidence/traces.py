"""A trace as files and back: npz with units in the names, described in `arrays.json`."""

import zlib
from collections.abc import Mapping
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from robo_genesis.evidence.bundle import Arrays, BundleRefused, CaseArrays, Variable
from robo_genesis.robot_model import JointMap
from robo_genesis.trace import Trace, TraceError

# Trace field → name in the file, dimensions, unit (None: that of each DOF), long name.
FIELDS = {
    "t": ("t_s", ["state"], "s", "time of each state, the first before any step"),
    "q": ("q_rad_or_m", ["state", "dof"], None, "position"),
    "qd": ("qd_rad_s_or_m_s", ["step", "dof"], None, "velocity after each step"),
    "target": ("target_rad_or_m", ["step", "dof"], None, "position command of each step"),
    "control_force": (
        "control_force_Nm_or_N", ["step", "dof"], None, "get_dofs_control_force after each step"),
    "internal_force": (
        "internal_force_Nm_or_N", ["step", "dof"], None, "get_dofs_force after each step"),
    "start_control_force": (
        "start_control_force_Nm_or_N", ["dof"], None, "control force before the first step"),
    "start_qd": ("start_qd_rad_s_or_m_s", ["dof"], None, "velocity before the first step"),
    "effort_limit": ("effort_limit_Nm_or_N", ["dof"], None, "get_dofs_force_range, read back"),
    "link_pos": ("link_pos_m", ["state", "link", "axis"], "m", "link position in the world"),
    "link_quat": ("link_quat_wxyz", ["state", "link", "wxyz"], "1", "link orientation"),
}  # fmt: skip


def dof_units(name: str, joints: JointMap) -> list[str]:
    """Return the unit of each DOF for one array name of `FIELDS`."""
    if name.startswith(("q_", "target")):
        return list(joints.position_units)
    if "qd" in name:
        return [f"{unit}/s" for unit in joints.position_units]
    return list(joints.effort_units)


def write_traces(
    folder: Path,
    traces: Mapping[str, Trace],
    joints: JointMap,
    links: list[str],
    notes: Mapping[str, str] | None = None,
) -> Arrays:
    """Write `arrays/<case>.npz` for every trace and return their description.

    `notes` says by case in what its arrays differ from the long names; most cases need none.
    """
    (folder / "arrays").mkdir()
    cases = {}
    for case, trace in traces.items():
        values = {name: getattr(trace, field) for field, (name, *_) in FIELDS.items()}
        np.savez_compressed(folder / "arrays" / f"{case}.npz", **values)
        variables = {
            name: Variable(
                dims=dims,
                shape=list(values[name].shape),
                dtype=str(values[name].dtype),
                unit=dof_units(name, joints) if unit is None else unit,
                long_name=long_name,
            )
            for name, dims, unit, long_name in FIELDS.values()
        }
        cases[case] = CaseArrays(
            file=f"arrays/{case}.npz", note=(notes or {}).get(case, ""), variables=variables
        )
    return Arrays(coords={"dof": list(joints.names), "link": links}, cases=cases)


def read_trace(folder: Path, arrays: Arrays, case: str) -> Trace:
    """Return one case's trace after holding its arrays against their description.

    Raises:
        BundleRefused: the file cannot be read, has other arrays than described, or its arrays do
            not form one run.
    """
    described = arrays.cases[case]
    if described.file != f"arrays/{case}.npz":
        raise BundleRefused(
            "path", f"arrays.json puts {case} at {described.file!r}, expected arrays/{case}.npz."
        )
    try:
        with (folder / described.file).open("rb") as stream:
            archive = np.lib.npyio.NpzFile(stream, allow_pickle=False)
            values = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, KeyError, BadZipFile, zlib.error) as error:
        raise BundleRefused("bad-array", f"{described.file}: {error}. Record it again.") from error
    if set(values) != set(described.variables) or set(values) != {n for n, *_ in FIELDS.values()}:
        raise BundleRefused("bad-array", f"{described.file} has other arrays than arrays.json.")
    for name, variable in described.variables.items():
        found = (list(values[name].shape), str(values[name].dtype))
        if found != (variable.shape, variable.dtype):
            raise BundleRefused(
                "bad-array", f"{described.file} {name} is {found}, described as "
                f"{(variable.shape, variable.dtype)}. Record the bundle again.",
            )  # fmt: skip
    try:
        return Trace(**{field: values[name] for field, (name, *_) in FIELDS.items()})
    except TraceError as error:
        raise BundleRefused("bad-trace", f"{described.file}: {error}") from error
