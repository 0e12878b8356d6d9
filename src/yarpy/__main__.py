"""`python -m yarpy` is the command `yarpy`."""

from yarpy.cli.main import main

if __name__ == "__main__":
    main()
