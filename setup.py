"""The wheel of the compiler: its modules, and the templates as data of the package `derive.templates`."""

from setuptools import find_packages, setup

setup(
    packages=[*find_packages(include=["derive*"]), "derive.templates"],
    package_dir={"derive.templates": "templates"},
    package_data={"derive.templates": ["**/*"]},
)
