"""Named checks of L09; the docstring of each is its claim."""

from robo_genesis.core import statistics
from robo_genesis.core.checks import Findings, above, at_most, below, equal
from robo_genesis.core.experiment import Experiment
from robo_genesis.sim.common_checks import posture, structure

from . import spec


def difference(run: Experiment, name: str, base: str) -> tuple[float, float, float]:
    """Return by how much the networks of one kind succeed more often, with its interval."""
    apart = run.traces[name].shares - run.traces[base].shares
    return statistics.of_groups(apart)


def experts_succeed(run: Experiment) -> Findings:
    """Each expert succeeds in at least 120 of 128 episodes."""
    for name, good in run.readings["experts"].items():
        yield above(f"{name}.success", good, 119.5)


def trained(run: Experiment) -> Findings:
    """The loss of each network falls by more than a factor of five, and all weights differ."""
    for name, of in run.page.runs.items():
        if of.measured:
            trace = run.traces[name]
            most = (trace.loss[-1] / trace.loss[0]).max()
            yield below(f"{name}.loss_left", most, 0.2)
            yield equal(
                f"{name}.networks", len({*trace.weights.tolist()}), spec.NETWORKS
            )


EVERYWHERE = (structure, experts_succeed, trained)


def phase_is_not_enough(run: Experiment) -> Findings:
    """With the phase as an input, clones of the expert that waits have a smaller error and
    succeed in at most 16 of 128 episodes, and those without waits more often, by the
    interval of the difference.
    """
    phase, waiting = run.metrics["waiting_phase"], run.metrics["waiting"]
    yield below("waiting_phase.error_rad", phase.error, waiting.error)
    yield at_most("waiting_phase.success", phase.resting, 16)
    low = difference(run, "prompt", "waiting_phase")[1]
    yield above("prompt.more_than_waiting_phase", low, 0)


def waits_are_the_cause(run: Experiment) -> Findings:
    """Without waits clones succeed more often, by the interval of the difference. With
    waits they succeed in at most 16 of 128 episodes, and hold the object in at most half;
    those without hold it in at least three quarters.
    """
    yield above("prompt.more_than_waiting", difference(run, "prompt", "waiting")[1], 0)
    yield above("prompt.more_than_delayed", difference(run, "prompt", "delayed")[1], 0)
    for name in ("waiting", "delayed"):
        yield at_most(f"{name}.success", run.metrics[name].resting, 16)
        yield at_most(f"{name}.held", run.metrics[name].held, 64)
    yield above("prompt.held", run.metrics["prompt"].held, 95)


def phase_helps_then(run: Experiment) -> Findings:
    """With waits and without the orientation, clones that see the phase succeed more often
    than with both, with neither change and with the orientation alone left out, by the
    intervals of the differences.
    """
    for base in ("waiting", "waiting_no_turn", "waiting_phase"):
        low = difference(run, "waiting_both", base)[1]
        yield above(f"waiting_both.more_than_{base}", low, 0)


def two_causes(run: Experiment) -> Findings:
    """Without the orientation, clones of the expert that does not wait succeed more often
    than with it, and than those of the expert that waits, with and without the phase, by
    the intervals of the differences.
    """
    name = "no_turn"
    yield at_most("waiting_no_turn.success", run.metrics["waiting_no_turn"].resting, 16)
    for base in ("prompt", "waiting_no_turn", "waiting_both"):
        yield above(f"{name}.more_than_{base}", difference(run, name, base)[1], 0)


def error_does_not_rank(run: Experiment) -> Findings:
    """Clones with the phase have a smaller error than those of the expert that does not
    wait, and succeed less often.
    """
    phase, prompt = run.metrics["waiting_phase"], run.metrics["prompt"]
    yield below("waiting_phase.error_rad", phase.error, prompt.error)
    yield below("waiting_phase.success", phase.resting, prompt.resting)


def chunks_help(run: Experiment) -> Findings:
    """With five commands at once clones succeed more often, by the interval of the
    difference, and their error is larger. With waits most hold the object, and fewer
    succeed than without waits and chunks.
    """
    few = run.metrics["waiting_five"]
    yield above("waiting_five.held", few.held, 64)
    yield below("waiting_five.success", few.resting, run.metrics["prompt"].resting)
    yield above("five.more_than_prompt", difference(run, "five", "prompt")[1], 0)
    error = run.metrics["prompt"].error
    yield above("five.error_rad", run.metrics["five"].error, error)


LECTURE = (
    *EVERYWHERE,
    phase_is_not_enough,
    waits_are_the_cause,
    phase_helps_then,
    two_causes,
    error_does_not_rank,
    chunks_help,
)


def postures_differ(run: Experiment) -> Findings:
    """Two postures for one place of the hand differ by more than 0.1 rad in a joint, and by
    less than 2 mm of the hand.
    """
    found = run.readings["postures"]
    yield above("postures.joints_rad", found["joints"], 0.1)
    yield below("postures.hand_m", found["hand"], 2e-3)


def answers_contradict(run: Experiment) -> Findings:
    """With answers whose postures are always solved again, the error in demonstrations is
    more than twice as large as without answers, and as with the others.
    """
    error = run.metrics["always"].error
    for name in ("few", "elsewhere"):
        yield above(f"always.error_over_{name}", error, 2 * run.metrics[name].error)


ASKING = (*EVERYWHERE, postures_differ, answers_contradict)


def silent_input_harms(run: Experiment) -> Findings:
    """Without the orientation of the object clones succeed more often, by the interval of
    the difference. A least spread repairs a part.
    """
    yield above("no_turn.more", difference(run, "no_turn", "prompt")[1], 0)
    floor = run.metrics["floor"].resting
    yield above("floor.success", floor, run.metrics["prompt"].resting)
    yield below("floor.success_below", floor, run.metrics["no_turn"].resting)


def noise_helps(run: Experiment) -> Findings:
    """With noise in the demonstrations clones succeed more often, by the interval of the
    difference, and their error is more than half as large.
    """
    yield above("noisy.more", difference(run, "noisy", "prompt")[1], 0)
    error = run.metrics["prompt"].error
    yield above("noisy.error_rad", run.metrics["noisy"].error, error / 2)


def relative_outputs_help(run: Experiment) -> Findings:
    """With relative outputs clones succeed more often, by the interval of the difference,
    and their error is smaller.
    """
    yield above("difference.more", difference(run, "difference", "prompt")[1], 0)
    error = run.metrics["prompt"].error
    yield below("difference.error_rad", run.metrics["difference"].error, error)


def last_command_does_not_help(run: Experiment) -> Findings:
    """With the last command as an input the rate rises by less than 20 points."""
    yield below("last.more", difference(run, "last", "prompt")[0], 0.2)


def training_helps(run: Experiment) -> Findings:
    """With twice the training the loss is less than half, and clones succeed more often, by
    the interval of the difference.
    """
    loss = run.metrics["prompt"].loss
    yield below("longer.loss", run.metrics["longer"].loss, loss / 2)
    yield above("longer.more", difference(run, "longer", "prompt")[1], 0)


INPUTS = (
    *EVERYWHERE,
    silent_input_harms,
    noise_helps,
    relative_outputs_help,
    last_command_does_not_help,
    training_helps,
)
LAB = (*EVERYWHERE, posture)
