// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Scores and tables, against cases computed by hand, and the pictures' numbers.

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

#include <set>

#include "evaluation/calibration.hpp"
#include "evaluation/pictures.hpp"
#include "evaluation/report.hpp"
#include "evaluation/tables.hpp"

namespace opencv_test { namespace {

using namespace hdp_tools;

const float none = NO_DISPARITY;

Pair makePair(Pair::Protocol protocol, const Mat& truth, const Mat& judged)
{
    Pair pair;
    pair.protocol = protocol;
    pair.truth = truth;
    pair.judged = judged;
    return pair;
}

TEST(HDPStereo_Evaluation, middlebury_by_hand)
{
    const Mat truth = Mat_<float>({ 2, 5 }, { 10, 10, 10, 10, 10, 20, 20, 20, none, 20 });
    const Mat judged = Mat_<uchar>({ 2, 5 }, { 255, 255, 255, 255, 255, 255, 255, 255, 0, 0 });
    // Errors: 0, 0.9375, 1, 1.9375, 2; none, 100, -0.5; not judged: 5 and none
    const Mat map = Mat_<float>({ 2, 5 }, { 10, 10.9375f, 9, 11.9375f, 12, none, 120, 19.5f, 5, none });
    const Score score = scoreMap(map, makePair(Pair::MIDDLEBURY, truth, judged));
    EXPECT_DOUBLE_EQ(100. * 5 / 8, score.error1);
    EXPECT_DOUBLE_EQ(100. * 3 / 8, score.error2);
    EXPECT_NEAR((0 + 0.9375 + 1 + 1.9375 + 2 + 64 + 64 + 0.5) / 8, score.average, 1e-6);
    EXPECT_DOUBLE_EQ(100, score.occluded); // one pixel of known truth
    EXPECT_TRUE(std::isnan(score.d1NonOccluded));
}

TEST(HDPStereo_Evaluation, kitti_by_hand)
{
    const Mat truth = Mat_<float>({ 1, 7 }, { 100, 100, 100, 20, 20, none, 20 });
    // Errors: 4 (below 5 %), 5 (not above), 5.5, 3 (not above), 3.25, of unknown truth, none
    const Mat map = Mat_<float>({ 1, 7 }, { 104, 95, 105.5f, 23, 16.75f, 3, none });
    Pair pair = makePair(Pair::KITTI, truth, knownPixels(truth));
    pair.judgedNonOccluded = Mat_<uchar>({ 1, 7 }, { 255, 255, 255, 255, 0, 0, 0 });
    const Score score = scoreMap(map, pair);
    EXPECT_DOUBLE_EQ(100. * 3 / 6, score.d1);
    EXPECT_DOUBLE_EQ(100. * 1 / 4, score.d1NonOccluded);
    EXPECT_NEAR((4 + 5 + 5.5 + 3 + 3.25 + 64) / 6, score.average, 1e-6);
    EXPECT_DOUBLE_EQ(100, score.occluded); // 3.25 and none
    pair.judgedNonOccluded.release();
    EXPECT_TRUE(std::isnan(scoreMap(map, pair).d1NonOccluded));
    EXPECT_TRUE(std::isnan(scoreMap(map, pair).occluded));
}

TEST(HDPStereo_Evaluation, sparsification_by_hand)
{
    const Mat wrong = Mat_<uchar>({ 1, 6 }, { 0, 255, 0, 255, 255, 0 });
    const Mat judged = Mat_<uchar>({ 1, 6 }, { 255, 255, 255, 255, 0, 0 });
    const double least = 25 * (2 - 2 * std::log(2.)); // no errors in the first half, then from none to a half
    const struct
    {
        Mat confidence;
        double area;
    } cases[] = { { Mat_<uchar>({ 1, 6 }, { 200, 0, 200, 0, 255, 255 }), least },
                  { Mat_<uchar>({ 1, 6 }, { 255, 7, 9, 8, 0, 0 }), least },
                  { Mat(1, 6, CV_8UC1, cv::Scalar(3)), 50 },                                      // always a half
                  { Mat_<uchar>({ 1, 6 }, { 1, 2, 1, 2, 3, 3 }), 25 * (2 + 2 * std::log(2.)) } }; // wrong ones first
    Score score;
    for (const auto& c : cases)
    {
        findSparsification(wrong, judged, c.confidence, score);
        EXPECT_NEAR(c.area, score.sparsification, 1e-10);
        EXPECT_NEAR(least, score.leastSparsification, 1e-10);
    }
    findSparsification(Mat::zeros(1, 6, CV_8U), judged, wrong, score);
    EXPECT_EQ(0, score.sparsification);
    EXPECT_EQ(0, score.leastSparsification);
}

TEST(HDPStereo_Evaluation, errors_by_confidence_by_hand)
{
    // Errors: 0, 1 (not above), 1.5, none, 20; of unknown truth. 300 of each, as few pixels make no share
    const Mat truth = repeat(Mat(Mat_<float>({ 1, 6 }, { 10, 10, 10, 10, 30, none })), 300, 1);
    const Mat map = repeat(Mat(Mat_<float>({ 1, 6 }, { 10, 11, 8.5f, none, 10, 10 })), 300, 1);
    const Mat confidence = repeat(Mat(Mat_<uchar>({ 1, 6 }, { 255, 100, 100, 0, 20, 200 })), 300, 1);
    ConfidenceErrors errors;
    EXPECT_TRUE(std::isnan(errors.share(0)));
    errors.add(confidence, map, truth);
    errors.add(confidence, map, truth);
    EXPECT_DOUBLE_EQ(100, errors.share(0));
    EXPECT_DOUBLE_EQ(80, errors.share(20));
    EXPECT_DOUBLE_EQ(60, errors.share(100));
    EXPECT_DOUBLE_EQ(20, errors.share(101));
    EXPECT_DOUBLE_EQ(60, errors.wrong(0));
    EXPECT_DOUBLE_EQ(50, errors.wrong(1));
    EXPECT_DOUBLE_EQ(100. / 3, errors.wrong(21));
    EXPECT_TRUE(std::isnan(errors.wrong(101))); // 600 pixels
}

TEST(HDPStereo_Evaluation, plot_of_calibration)
{
    Table table;
    table.header = { "sigma, pixels", "one", "a & b" };
    const std::vector<std::vector<double>> rows = { { 50, 100 }, { 0, NO_SCORE }, { 40, 80 } };
    for (size_t i = 0; i < rows.size(); i++)
    {
        table.addRow(i + 1 < rows.size() ? cv::format("%d", (int)i) : String("all"));
        for (const double value : rows[i])
            table.addNumber(value, "%.0f");
    }
    const String svg = calibrationPlot(table);
    // 420 x 300 from (50, 10) on; the row of all is no level, and what is unknown no point.
    EXPECT_NE(String::npos, svg.find("points='155,160 365,310 '"));
    EXPECT_NE(String::npos, svg.find("points='155,10 '"));
    EXPECT_NE(String::npos, svg.find(">a &amp; b</text>"));
    EXPECT_EQ(String::npos, svg.find(">all</text>"));
}

TEST(HDPStereo_Evaluation, bad_pixels_by_hand)
{
    const Mat truth = Mat_<float>({ 1, 9 }, { 10, 10, 10, 10, 10, 10, 10, none, 10 });
    // Errors: 0, 0.5 (not above), 0.75, 1 (not above 1), 2, 2.5, 4.25; of unknown truth; none
    const Mat map = Mat_<float>({ 1, 9 }, { 10, 10.5f, 9.25f, 11, 8, 12.5f, 14.25f, 10, none });
    const Pair pair = makePair(Pair::BAD, truth, knownPixels(truth));
    const Score score = scoreMap(map, pair);
    EXPECT_DOUBLE_EQ(100. * 6 / 8, score.badHalf);
    EXPECT_DOUBLE_EQ(100. * 4 / 8, score.bad1);
    EXPECT_DOUBLE_EQ(100. * 3 / 8, score.bad2);
    EXPECT_DOUBLE_EQ(100. * 2 / 8, score.bad4);
    EXPECT_DOUBLE_EQ(100. * 1 / 8, score.invalid);
    EXPECT_NEAR((0 + 0.5 + 0.75 + 1 + 2 + 2.5 + 4.25 + 64) / 8, score.average, 1e-6);
    EXPECT_EQ(score.bad2, mainScore(score, pair.protocol));
    expectIdentical(Mat_<uchar>({ 1, 9 }, { 0, 0, 0, 0, 0, 255, 255, 0, 255 }), wrongPixels(map, pair));
}

TEST(HDPStereo_Evaluation, no_truth_no_score)
{
    const Score score = scoreMap(Mat(3, 3, CV_32F, Scalar(1)), makePair(Pair::NO_TRUTH, Mat(), Mat()));
    EXPECT_TRUE(std::isnan(score.error1) && std::isnan(score.error2) && std::isnan(score.d1) &&
                std::isnan(score.d1NonOccluded) && std::isnan(score.average));
}

TEST(HDPStereo_Evaluation, occlusion_by_hand)
{
    const Mat left = Mat_<float>({ 1, 6 }, { 1, 2, 2, 2.5f, none, 3 }),
              right = Mat_<float>({ 1, 6 }, { 2, 2.5f, 4, none, 2, 1 });
    // x - floor(d): -1, -1, 0 (2 = 2), 1 (2.5 = 2.5), unknown, 2 (3, 4)
    expectIdentical(Mat_<uchar>({ 1, 6 }, { 0, 0, 255, 255, 0, 0 }), nonOccludedPixels(left, right));
    expectIdentical(Mat_<uchar>({ 1, 6 }, { 0, 0, 255, 255, 0, 255 }), nonOccludedPixels(left, right, 1));
}

TEST(HDPStereo_Evaluation, means_leave_out_what_is_missing)
{
    EXPECT_DOUBLE_EQ(2.5, meanOf({ 1, NO_SCORE, 4 }));
    EXPECT_TRUE(std::isnan(meanOf({ NO_SCORE })));
    EXPECT_TRUE(std::isnan(meanOf({})));
}

TEST(HDPStereo_Evaluation, tables)
{
    Table table;
    table.title = "A, \"B\" & <C>";
    table.header = { "scene", "one", "two", "three", "four" };
    table.addRow("Aloe, Baby");
    table.addNumbers({ 3.14159, NO_SCORE, 2.004, 2.0001 });
    EXPECT_EQ("### A, \"B\" & <C>\n\n| scene | one | two | three | four |\n| --- | --- | --- | --- | --- |\n"
              "| Aloe, Baby | 3.14 | - | **2.00** | **2.00** |\n",
              toMarkdown(table));
    Table bars;
    bars.header = { "scene" };
    bars.addRow("A|B");
    EXPECT_NE(String::npos, toMarkdown(bars).find("\n| A\\|B |\n"));
    EXPECT_EQ("\"A, \"\"B\"\" & <C>\"\nscene,one,two,three,four\n\"Aloe, Baby\",3.14,,2.00,2.00\n", toCsv(table));
    const String html = toHtml(table);
    EXPECT_NE(String::npos, html.find("A, &quot;B&quot; &amp; &lt;C&gt;"));
    EXPECT_NE(String::npos, html.find("<td>3.14</td><td>-</td><td class=\"best\">2.00</td>"));
    EXPECT_EQ(String::npos, html.find("class=\"wide\""));
    table.header.resize(18, "a system");
    EXPECT_NE(String::npos, toHtml(table).find("<table class=\"wide\">"));
}

TEST(HDPStereo_Evaluation, base64_of_rfc_4648)
{
    const char* const vectors[][2] = { { "", "" },
                                       { "f", "Zg==" },
                                       { "fo", "Zm8=" },
                                       { "foo", "Zm9v" },
                                       { "foob", "Zm9vYg==" },
                                       { "fooba", "Zm9vYmE=" },
                                       { "foobar", "Zm9vYmFy" } };
    for (const auto& vector : vectors)
    {
        const String text = vector[0];
        EXPECT_EQ(vector[1], base64(std::vector<uchar>(text.begin(), text.end())));
    }
}

TEST(HDPStereo_Evaluation, truth_of_a_layer)
{
    const Mat truth = Mat_<float>({ 3, 5 }, { 8, 1, none, 3, 20, 1, 1, 1, 1, 1, 6, 1, 10, 1, 1 });
    const Mat first = truthOfLayer(truth, 1), second = truthOfLayer(truth, 2);
    ASSERT_EQ(Size(2, 1), first.size());
    EXPECT_EQ(4.f, first.at<float>(0, 0));
    EXPECT_EQ(none, first.at<float>(0, 1));
    EXPECT_TRUE(second.empty());
    expectIdentical(truth, truthOfLayer(truth, 0));
}

TEST(HDPStereo_Evaluation, sampled_matrix_counts_pairs)
{
    const Mat truth = Mat_<float>({ 2, 4 }, { 6, 6, 7, none, 5, 6, 20, 2 }), upper = Mat_<float>({ 1, 2 }, { 3, 1 });
    const Mat_<double> matrix = sampledMatrix(truth, upper, 9);
    ASSERT_EQ(Size(9, 5), matrix.size());
    EXPECT_EQ(3, matrix(3, 6));
    EXPECT_EQ(1, matrix(3, 5));
    EXPECT_EQ(1, matrix(1, 7));
    EXPECT_EQ(1, matrix(1, 2));
    EXPECT_EQ(6, sum(matrix)[0]); // not those of unknown truth, and of 20 disparities
}

TEST(HDPStereo_Evaluation, wrong_pixels_are_red_and_occluded_ones_black)
{
    const Vec3b red(0, 0, 255), black(0, 0, 0);
    const Mat truth = Mat_<float>({ 1, 6 }, { 10, 10, 60, none, 40, 60 }),
              map = Mat_<float>({ 1, 6 }, { 11.9375f, 12, 55.5f, 10, 40, none });
    const struct
    {
        Pair::Protocol protocol;
        bool wrong[6], blank[6];
    } cases[] = {
        { Pair::MIDDLEBURY, { false, true, true, false, false, true }, { false, false, false, true, true, false } },
        { Pair::KITTI, { false, false, true, false, false, true }, { false, false, false, false, false, false } },
        { Pair::NO_TRUTH, { false, false, false, false, false, false }, { false, false, false, false, false, true } },
    };
    for (const auto& c : cases)
    {
        // The last but one is occluded; KITTI's pictures do not show what is not judged.
        const Mat judged = Mat_<uchar>({ 1, 6 }, { 255, 255, 255, 0, 0, 255 });
        const Mat picture = resultPicture(map, makePair(c.protocol, truth, judged));
        for (int x = 0; x < truth.cols; ++x)
        {
            EXPECT_EQ(c.wrong[x], picture.at<Vec3b>(0, x) == red) << "protocol " << c.protocol << ", pixel " << x;
            EXPECT_EQ(c.blank[x], picture.at<Vec3b>(0, x) == black) << "protocol " << c.protocol << ", pixel " << x;
        }
    }
}

TEST(HDPStereo_Evaluation, every_tree_has_a_color)
{
    Mat trees(40, 50, CV_32S);
    for (int i = 0; i < 2000; ++i)
        trees.ptr<int>()[i] = i / 2;
    const Mat picture = forestPicture(trees);
    std::set<int> colors;
    for (int i = 0; i < 2000; ++i)
    {
        const Vec3b color = picture.ptr<Vec3b>()[i];
        EXPECT_EQ(picture.ptr<Vec3b>()[i / 2 * 2], color);
        colors.insert(color[0] | color[1] << 8 | color[2] << 16);
    }
    EXPECT_EQ(1000u, colors.size());
}

TEST(HDPStereo_Evaluation, widths_in_steps_of_the_logarithm)
{
    const Mat intervals = Mat_<Vec2w>({ 1, 4 }, { Vec2w(7, 7), Vec2w(0, 3), Vec2w(16, 23), Vec2w(0, 255) });
    const Mat levels = Mat_<uchar>({ 1, 4 }, { 0, 64, 96, 255 }); // of 1, 4, 8 and all 256 candidates
    Mat colors;
    cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
    expectIdentical(colors, widthPicture(intervals, 256));
}

TEST(HDPStereo_Evaluation, predicted_matrix_by_hand)
{
    const Ptr<DisparityPredictionModel> model = DisparityPredictionModel::create();
    model->addLayer({ 0.5 }, { 2 }, { 1 });
    const Mat_<double> matrix = predictedMatrix(*model, 0, { 1, 0, 3, 4, 0.5 });
    ASSERT_EQ(Size(5, 3), matrix.size());
    // exp(-(i - floor(j / 2) - 0.5)^2 / 8) / (2 sqrt(2 pi)) P(j)
    EXPECT_NEAR(0.193334 * 1, matrix(0, 0), 1e-5); // offset 0
    EXPECT_EQ(0, matrix(1, 1));
    EXPECT_NEAR(0.193334 * 3, matrix(2, 2), 1e-5);   // offset 1
    EXPECT_NEAR(0.150569 * 4, matrix(0, 3), 1e-5);   // offset -1
    EXPECT_NEAR(0.091325 * 0.5, matrix(0, 4), 1e-5); // offset -2
}

}} // namespace opencv_test
