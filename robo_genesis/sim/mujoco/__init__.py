"""The same models in MuJoCo, the second engine."""
