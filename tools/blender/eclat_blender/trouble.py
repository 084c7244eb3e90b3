"""The exception that ends a render, with one line for the user."""


class Trouble(Exception):
    pass
