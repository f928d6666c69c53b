"""The wheel of the compiler: its modules, and as data `derive.templates` and `derive.runtime`."""

from setuptools import find_packages, setup

setup(
    packages=[*find_packages(include=["derive*"]), "derive.templates", "derive.runtime"],
    package_dir={"derive.templates": "templates", "derive.runtime": "runtime"},
    package_data={"derive.templates": ["**/*"], "derive.runtime": ["**/*"]},
)
