"""The compiled kernel: its C sources, its libraries, and what ctypes feeds them."""
