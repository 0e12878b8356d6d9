"""Code for an interface: a module of Python, a module of TypeScript."""
