"""Recording the labs on a machine with an accelerator."""
