"""The packaged models, one file each."""
