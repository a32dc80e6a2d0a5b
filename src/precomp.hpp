// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PRECOMP_HPP
#define OPENCV_HDPSTEREO_PRECOMP_HPP

#include "opencv2/hdpstereo.hpp"
#include "opencv2/core/utils/trace.hpp"
#include "opencv2/imgproc.hpp"

#endif
