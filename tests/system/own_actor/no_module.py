"""A program that ends before it is connected."""
import no_such_module  # noqa: F401
