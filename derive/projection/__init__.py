"""From continua to coordinates: bases, integrals over them, and the projected action."""
