"""What people and programs talk to: the command line and the REST service."""

COMPILING = "compiling the kernels, once after an install: one and a half to two and a half minutes"
