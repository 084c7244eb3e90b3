"""What ends a render with one line for the user."""


class Trouble(Exception):
    pass
