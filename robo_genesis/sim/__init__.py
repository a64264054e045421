"""Everything that imports Genesis or MuJoCo."""
