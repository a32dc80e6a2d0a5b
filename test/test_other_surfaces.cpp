// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "window_prediction.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_OtherSurfaces, rule)
{
    RNG rng(60);
    hdp::SurfaceBuffers buffers;
    Mat others;
    int found = 0;
    for (const Size& size : { Size(1, 1), Size(4, 1), Size(35, 20), Size(80, 18), Size(20, 161) })
        for (int numDisparities : { 1, 12, 70 })
        {
            SCOPED_TRACE(testing::Message() << size << ", disparities " << numDisparities);
            Prediction prediction(patchesAbove(rng, size, numDisparities, 7));
            prediction.addThinStructures(rng, numDisparities);
            hdp::findOtherSurfaces(prediction.upper, prediction.unfiltered, buffers, others);
            ASSERT_EQ(size, others.size());
            ASSERT_EQ(CV_16UC1, others.type());
            for (int y = 0; y < size.height; ++y)
                for (int x = 0; x < size.width; ++x)
                {
                    ASSERT_EQ(oracle::otherSurface(prediction, y, x), others.at<ushort>(y, x))
                        << "y " << y << " x " << x;
                    found += others.at<ushort>(y, x) != 2 * prediction.upper.at<ushort>(y, x);
                }
        }
    EXPECT_GT(found, 1000) << "nothing is tested where there are none";
}

}} // namespace opencv_test
