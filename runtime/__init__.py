"""Run-time side: scenes, solvers, charts, results, plots and the command line."""
