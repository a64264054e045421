"""Studies of the deeper page about energy: the release of a landing, and the bounce of a ball."""

from collections.abc import Iterator

from robo_genesis.core.checks import Finding, at_most, within
from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l03 import checks, study, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR


def release_speed(run: Experiment) -> Iterator[Finding]:
    """With fine steps and time constants of 10, 5 and 2 ms, a contact releases a cube at e⁻² of its
    impact speed, within 10 %.
    """
    for scene, cases in study_spec.RELEASE_CASES.items():
        for found, (name, case) in zip(
            study.landings_of(run.metrics, scene), cases.items(), strict=True
        ):
            expected = theory.release_speed(case)
            allowed = study_spec.RELEASE_SHARE * expected
            yield within(f"{name}.upward_speed_m_s", found.upward_speed, expected, allowed)


def stiff_contacts_rebound(run: Experiment) -> Iterator[Finding]:
    """With 10 ms no cube rebounds; with 5 ms and 2 ms each rebounds as from a linear contact,
    within 25 %.
    """
    for scene, cases in study_spec.RELEASE_CASES.items():
        for found, (name, case) in zip(
            study.landings_of(run.metrics, scene), cases.items(), strict=True
        ):
            expected, label = theory.rebound(case), f"{name}.rebound_m"
            if expected:
                allowed = study_spec.REBOUND_SHARE * expected
                yield within(label, found.rebound, expected, allowed)
            else:
                yield at_most(label, found.rebound, CLEAR)


CHECKS = (
    study.time_constants, release_speed, stiff_contacts_rebound, checks.level_in_flight,
    checks.energy_converges,
)  # fmt: skip
