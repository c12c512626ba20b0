"""What every room shares: families, results, errors, units, inputs, series, pictures."""
