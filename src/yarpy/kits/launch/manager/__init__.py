"""The words of C++ yarpmanager-console, said to applications that `yarpy up` runs."""
