"""Values in words, and the text that the lab generates about its runs."""

from types import SimpleNamespace

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.tables import sentence_of
from robo_genesis.core.text import blocks, readable

MEASURES = False

# By title, what the lab says if a check passed, with the metrics of its runs.
SENTENCES = {
    "The landings": {
        "lands": "Each cube touches the table. Its depth is {baseline.penetration} with two steps "
        "of 5 ms, {dt10_sub1.penetration} with one step of 10 ms, {dt20_sub2.penetration} with "
        "two steps of 10 ms, and {dt20_sub1.penetration} with one step of 20 ms.",
        "settles": "In this order, the cubes settle at {baseline.resting_time}, "
        "{dt10_sub1.resting_time}, {dt20_sub2.resting_time} and {dt20_sub1.resting_time}.",
        "reported_late": "With one substep, a reported depth is that of the state before: it is "
        "one step old.",
    },
    "The effect of the step": {
        "equal_step_equal_states": "The runs with one step of 10 ms and two steps of 10 ms have "
        "equal states at shared times. Their solver steps are equal; the outer step only sets how "
        "often the state is read.",
        "one_factor": "The compared runs with the same outer step differ in substeps alone. In the "
        "order above, the rebounds are {baseline.rebound}, {dt10_sub1.rebound}, "
        "{dt20_sub2.rebound} and {dt20_sub1.rebound}. These runs cannot show whether a rebound is "
        "physics or numerical error: the lecture tests smaller steps and other heights.",
    },
    "The slides": {
        "stops": "On the table with 0.5, the cube with 0.1 stops at {low_on_050.stop_time} after "
        "{low_on_050.stop_distance}, and the cube with 0.8 at {high_on_050.stop_time} after "
        "{high_on_050.stop_distance}.",
        "near_coulomb": "Each distance is within 20 % of v² / (2 μ g) with the larger coefficient. "
        "This alone does not show a slide: on this table the hops are {low_on_050.hop} and "
        "{high_on_050.hop}, and the cubes turn at up to {low_on_050.spin} and {high_on_050.spin}. "
        "A cube that hops does not slide as the formula assumes.",
    },
    "Which friction counts": {
        "friction_orders": "On the table with 0.3, the cube with 0.1 travels farther: "
        "{low_on_030.stop_distance}. The cube with 0.8 stops after {high_on_030.stop_distance}, as "
        "on the other table: its own coefficient is the larger one on both."
    },
    "The energy of the ball": {
        "energy_converges": "At the first bounce with the finest step, the ball keeps "
        "{bounce_sub100.first_kept} of its energy, as on a linear spring with this damping: the "
        "contact's own damping causes the whole loss. With one to four substeps it keeps "
        "{bounce_sub1.first_kept}, {bounce_sub2.first_kept} and {bounce_sub4.first_kept}. What "
        "differs is numerical error, and a share above 100 % is more energy than it had.",
        "level_in_flight": "Within a flight the total energy changes by up to "
        "{bounce_sub1.flight_change} with one substep, and by {bounce_sub100.flight_change} with a "
        "hundred. This error is bounded: without m g h v / 2, the energy with a hundred changes "
        "by {bounce_sub100.flight_drift}.",
    },
}

ADVICE = (
    "Look first at the settings of the cases, the times of the samples, "
    "and contacts with the body."
)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs, or what a failed check found in their place."""
    values = {
        name: SimpleNamespace(
            **{n: readable(value, unit) for n, value, unit in of.items()}
        )
        for name, of in run.metrics.items()
    }
    checks = {check.name: check for check in run.outcomes()}
    said = {
        title: [
            sentence_of(checks[name], of, values, ADVICE)
            for name, of in sentences.items()
        ]
        for title, sentences in SENTENCES.items()
    }
    return blocks(said)


def milliseconds(seconds: float) -> str:
    """Write a time in milliseconds: `0.125 ms`."""
    return f"{1000 * seconds:.3g} ms"


def millimetres(length: float) -> str:
    """Write a length in millimetres with three significant digits: `7.54 mm`."""
    value = 1000 * length
    return f"{value:#.3g} mm" if abs(value) >= 0.01 else "0 mm"
