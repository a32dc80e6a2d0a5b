// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "mgm_program.hpp"

#ifdef __unix__

namespace opencv_test { namespace {

//! A tile of an aerial pair, with mgm's disparities from -227 to -20
struct Tile
{
    Tile() : visible(1024, 1024, CV_8U, Scalar(0))
    {
        const int shift = 20;
        const SyntheticPair wide = makeSyntheticPair(Size(visible.cols + shift, visible.rows), 230, 11);
        cvtColor(wide.left.colRange(0, visible.cols), left, COLOR_BGR2GRAY);
        cvtColor(wide.right.colRange(shift, wide.right.cols), right, COLOR_BGR2GRAY);
        truth = -(wide.truth.colRange(0, visible.cols) + shift);
        for (int y = 0; y < truth.rows; y++)
            for (int x = 0; x < truth.cols; x++)
                visible.at<uchar>(y, x) = x + truth.at<float>(y, x) >= 0 ? wide.visible.at<uchar>(y, x) : 0;
    }

    static const Tile& get()
    {
        static const Tile tile;
        return tile;
    }

    //! The share of pixels that are right within 1, of those that are visible and have data in both images
    double hits(const Mat& disparity, const Mat& leftData, const Mat& rightData) const
    {
        EXPECT_EQ(CV_32FC1, disparity.type());
        EXPECT_EQ(truth.size(), disparity.size());
        int hits = 0, total = 0;
        for (int y = 0; y < truth.rows; y++)
            for (int x = 0; x < truth.cols; x++)
            {
                const float d = truth.at<float>(y, x);
                if (!visible.at<uchar>(y, x) || !leftData.at<uchar>(y, x) || !rightData.at<uchar>(y, cvRound(x + d)))
                    continue;
                total++;
                hits += std::abs(disparity.at<float>(y, x) - d) <= 1; // NaN is not
            }
        return hits / (double)total;
    }

    Mat left, right, truth, visible;
};

//! Pixels with a disparity that leads to where the right image has no data, as 8 bits of 0 and 255 say
int countOutside(const Mat& disparity, const Mat& rightData)
{
    int outside = 0;
    for (int y = 0; y < disparity.rows; y++)
        for (int x = 0; x < disparity.cols; x++)
        {
            const float column = std::round(x + disparity.at<float>(y, x));
            outside += column < 0 || column >= rightData.cols ||
                       (column == column && rightData.at<uchar>(y, (int)column) == 0);
        }
    return outside;
}

TEST(HDPStereo_MgmTiles, of_the_Ames_Stereo_Pipeline)
{
    MgmTest test;
    const Tile& tile = Tile::get();
    Mat left, right;
    tile.left.convertTo(left, CV_32F, 1 / 255.);
    tile.right.convertTo(right, CV_32F, 1 / 255.);
    // What a projection leaves empty: margins, and a corner
    Mat leftData(left.size(), CV_8U, Scalar(0)), rightData(leftData.clone());
    leftData(Rect(30, 20, 960, 980)).setTo(255);
    rightData(Rect(90, 40, 900, 940)).setTo(255);
    for (int y = 0; y < 300; y++)
        leftData.row(y).colRange(0, 300 - y).setTo(0);
    left.setTo(none, ~leftData);
    right.setTo(none, ~rightData);
    test.save(left, right);
    const Mat disparity = test.match("-r -227.6 -R -19.5 -s vfit -t census -O 8",
                                     "MEDIAN=1 CENSUS_NCC_WIN=5 USE_TRUNCATED_LINEAR_POTENTIALS=1 TSGM=3");
    const Mat known = disparity == disparity;
    EXPECT_EQ(0, cv::countNonZero(known & ~leftData));
    EXPECT_EQ(0, countOutside(disparity, rightData));
    EXPECT_GT(tile.hits(disparity, leftData, rightData), 0.9);
}

TEST(HDPStereo_MgmTiles, of_s2p)
{
    MgmTest test;
    const Tile& tile = Tile::get();
    Mat left, right;
    tile.left.convertTo(left, CV_16U, 8, 300); // 11 bits
    tile.right.convertTo(right, CV_16U, 8, 300);
    test.save(left, right);
    const String options =
        "-r -230 -R -20 -s vfit -t census -O 8 -confidence_consensusL " + test.folder.path("out_confidence.tif");
    const String environment = "OMP_NUM_THREADS=2 MEDIAN=1 CENSUS_NCC_WIN=5 TSGM=3 TESTLRRL_TAU=1.0 MINDIFF=-1";
    const Mat everywhere(right.size(), CV_8U, Scalar(255));
    const Mat disparity = test.match(options, environment + " TESTLRRL=1");
    EXPECT_EQ(0, countOutside(disparity, everywhere));
    EXPECT_GT(tile.hits(disparity, everywhere, everywhere), 0.9);
    const Mat confidence = test.image("out_confidence.tif");
    EXPECT_EQ(0, cv::countNonZero(~(disparity == disparity) & (confidence > 0)));

    const Mat all = test.match(options, environment + " TESTLRRL=0");
    EXPECT_EQ((int)all.total(), cv::countNonZero(all == all)) << "mgm keeps them without the check";
    EXPECT_GT(countOutside(all, everywhere), 10000);
    EXPECT_EQ(0, cv::norm(all, disparity, NORM_INF, disparity == disparity));
}

TEST(HDPStereo_MgmTiles, beside_each_other)
{
    MgmTest test;
    test.save(Tile::get().left, Tile::get().right);
    const String options = "-r -1890.5 -R -1880.2 -s vfit -Rd " + test.folder.path("right_map.tif"),
                 preset = "HDPSTEREO_PRESET=fast";
    const Mat disparity = test.match(options, preset), ofRight = test.image("right_map.tif");
    EXPECT_EQ(0, cv::countNonZero(disparity == disparity));
    EXPECT_EQ(Tile::get().right.size(), ofRight.size());
    EXPECT_EQ(0, cv::countNonZero(ofRight == ofRight));
    const Mat all = test.match(options, preset + " TESTLRRL=0");
    EXPECT_EQ(0, cv::countNonZero(~(all == all)));
}

}} // namespace opencv_test

#endif // __unix__
