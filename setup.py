# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''For scikit-build, see python/build_backend.py. The rest is in pyproject.toml.'''

import re

from skbuild import setup

with open('CMakeLists.txt', encoding='utf-8') as f:
    VERSION = re.search(r'project\(hdpstereo VERSION ([0-9.]+)', f.read())[1]

setup(version=VERSION, packages=['hdpstereo'], package_dir={'': 'python'}, cmake_install_dir='python',
      cmake_args=['-DHDPSTEREO_WHEEL=ON'])
