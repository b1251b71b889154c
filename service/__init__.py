"""What people and programs talk to: the command line and the REST service."""

COMPILING = "compiling the kernels, once after an install: about a minute and a half"
