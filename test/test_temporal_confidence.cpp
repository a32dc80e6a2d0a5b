// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_video.hpp"
#include "../src/video/temporal_join.hpp"

namespace opencv_test { namespace {

TEST(HDPStereo_TemporalConfidence, oracle)
{
    RNG rng(91);
    for (int most : { 1, 2, 7 })
    {
        const Size size(rng.uniform(5, 40), rng.uniform(5, 40));
        const Mat before = randomImage(rng, size, CV_8UC1);
        hdp::FrameMemory frame;
        frame.detail.create(size, CV_8U);
        for (int i = 0; i < (int)size.area(); ++i)
            frame.detail.data[i] = (uchar)(rng.uniform(0, 16) * 16 + rng.uniform(1, most + 1));
        frame.detail.data[0] = (uchar)most;
        Mat confidence = before.clone();
        hdp::trustStable(frame, confidence);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int count = frame.detail.at<uchar>(y, x) % 16;
                const double expected = before.at<uchar>(y, x) * std::sqrt((count + 1.) / (most + 1));
                EXPECT_NEAR(expected, confidence.at<uchar>(y, x), 0.501);
            }
        if (most == 1)
            expectIdentical(before, confidence);
    }
}

//! What has just come into sight is trusted less than what has been there for some frames, unless it is the first frame.
TEST(HDPStereo_TemporalConfidence, of_a_video)
{
    SyntheticVideo video(Size(240, 160), 10, 2);
    const Board board = { Rect2d(100, 50, 60, 60), 22, 4 };
    const Ptr<HDPTreeMatcher> single = HDPTreeMatcher::create(0, 32), temporal = HDPTreeMatcher::create(0, 32);
    temporal->setUseTemporalPrediction(true);
    for (int i = 0; i < 4; ++i)
    {
        const SyntheticFrame frame = video.render(i, std::vector<Board>(i == 3 ? 1 : 0, board));
        Mat disparity, alone, joined, again;
        single->compute(frame.left, frame.right, disparity);
        single->getConfidence(alone);
        temporal->compute(frame.left, frame.right, disparity);
        temporal->getConfidence(joined);
        if (i == 0)
            expectIdentical(alone, joined);
        if (i < 3)
            continue;
        const Rect inside(115, 65, 20, 30), beside(180, 20, 40, 120);
        EXPECT_LT(mean(joined(inside))[0], 0.75 * mean(alone(inside))[0]) << "what is new";
        EXPECT_GT(mean(joined(beside))[0], 0.95 * mean(alone(beside))[0]) << "what is not";
        temporal->clear();
        temporal->getConfidence(again);
        expectIdentical(joined, again);
    }
}

//! Of rows that are smaller than a cell, a frame leaves nothing to the next one.
TEST(HDPStereo_TemporalConfidence, smaller_than_a_cell)
{
    RNG rng(92);
    const Ptr<HDPTreeMatcher> single = HDPTreeMatcher::create(0, 16), temporal = HDPTreeMatcher::create(0, 16);
    temporal->setUseTemporalPrediction(true);
    for (const Size size : { Size(40, 1), Size(60, 50), Size(40, 1), Size(1, 40) })
    {
        const Mat left = randomImage(rng, size, CV_8UC1), right = randomImage(rng, size, CV_8UC1);
        Mat disparity, alone, joined;
        single->compute(left, right, disparity);
        single->getConfidence(alone);
        temporal->compute(left, right, disparity);
        temporal->getConfidence(joined);
        expectIdentical(alone, joined);
    }
}

}} // namespace opencv_test
