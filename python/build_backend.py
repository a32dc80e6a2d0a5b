# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''What pip builds with: scikit-build-core, or where there is none, as on Debian 12, setup.py and scikit-build.'''

try:
    from scikit_build_core.build import *
except ImportError:
    from setuptools.build_meta import *
