"""Named cases: Mathieu, Whittaker and Hill, Meissner; piecewise constant coefficients."""
