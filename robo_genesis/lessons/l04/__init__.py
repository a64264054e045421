"""L04, robot models, degrees of freedom, and joint control."""
