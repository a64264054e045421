import pytest

from robo_genesis.core.text import scaled_value


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.00447, "mm", "4.47 mm"), (0.0123, "%", "1.23 %"), (0.5, "rad", "0.500 rad"),
        (12.345, "mm", "12300 mm"), (0.9, "%", "90.0 %"), (1e-9, "m", "0.000000001 m"),
        (-3e-8, "mm", "-0.00003 mm"), (0.0, "mm", "0.00 mm"),
    ],
)  # fmt: skip
def test_a_value_in_another_unit_has_three_digits(value, unit, text):
    assert scaled_value(value, unit) == text
    with pytest.raises(LookupError, match="No text has the unit 'inch'"):
        scaled_value(value, "inch")
