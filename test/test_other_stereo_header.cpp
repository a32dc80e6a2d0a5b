// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The module stereo of opencv_contrib 4.x uses the namespace cv::stereo, too: a program may include both headers.
#if defined(__has_include)
#if __has_include("opencv2/stereo.hpp")
#include "opencv2/stereo.hpp"
#define HDPSTEREO_TEST_STEREO
#endif
#endif

#include "test_precomp.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_DropIn, header_of_the_other_stereo_module)
{
#ifdef HDPSTEREO_TEST_STEREO
    using namespace cv::stereo; // no name of one is ambiguous by the other
    EXPECT_EQ(64, HDPTreeMatcher::create()->getNumDisparities());
    EXPECT_EQ(0, DisparityPredictionModel::create()->getNumLayers());
#else
    throw SkipTestException("there is no opencv2/stereo.hpp");
#endif
}

}} // namespace opencv_test
