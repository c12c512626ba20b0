"""``python -m elastolink``: the command under another name."""

from importlib import import_module

if __name__ == "__main__":
    raise SystemExit(import_module("elastolink.runtime.cli").main())
