#!/usr/bin/env python3
"""Accelerations by EGM2008 for tests/forces/test_gravity_field.cpp, by PyPI's brahe. gravity_values.py"""
import brahe
import numpy

model = brahe.GravityModel.from_model_type(brahe.GravityModelType.EGM2008_120)
for place in ((6878137.0, 0.0, 0.0), (0.0, 0.0, 6778137.0), (-4069503.0, 2861786.0, -4483608.0), (30e6, -28e6, 9e6)):
    for degree in (2, 20, 70):
        a = model.compute_spherical_harmonics(numpy.array(place), degree, degree)
        print("{{%r, %r, %r}, %d, {%.17g, %.17g, %.17g}}," % (*place, degree, *a))
