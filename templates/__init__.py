"""Jinja2 templates of the emitted modules."""
