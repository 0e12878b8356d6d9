"""`python -m yarpy` is the command `yarpy`."""

from yarpy.cli.start import main

if __name__ == "__main__":
    main()
