"""Configured inputs become JSON values, and different inputs stay different."""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from robo_genesis.core.experiment import case_inputs


@dataclass
class Case:
    value: Any


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (np.array([[1, 2], [3, 4]]), [[1, 2], [3, 4]]),
        (np.float64(0.5), 0.5),
        (("a", 1), ["a", 1]),
        ((1, 2.5), [1, 2.5]),
        ((1, (2, 3)), [1, [2, 3]]),
        (None, None),
    ],
)
def test_a_value_keeps_its_types(value, written):
    found = json.loads(json.dumps(case_inputs({"one": Case(value)})))
    assert json.dumps(found) == json.dumps({"one": {"value": written}})
