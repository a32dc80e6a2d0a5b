// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches generated slanted planes, whose disparities have every fraction of a pixel, and tells how the errors depend on the
// fraction: whether whole disparities are preferred.

#include <cmath>
#include <iostream>

#include "opencv2/imgproc.hpp"

#include "evaluation/command_line.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"
#include "evaluation/tunables.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS =
    "{help h ? | | print this and exit }"
    "{methods  | ultrafast,fast,quality,tree,sgbm,sgbm-3way,sgbm-hh4 | names as of hdp_evaluate }"
    "{textures | natural,fine | natural: as much contrast in each octave; fine: of single pixels; separated by commas }"
    "{noise    | 2 | standard deviation of noise in both images, in grey levels }"
    "{threads  |   | number of threads; all processors if not given }";

static const Size planeSize(640, 480);
static const int planeDisparities = 48;
static const int margin = 16;    // pixels that are not judged: beside the image, and behind the border of the right one
static const double outlier = 1; // errors from here on are mismatches and not judged
static const int binsOfPixel = 16;

//! Disparity at the upper left corner, and its rise per column and per row
struct Plane
{
    double start, dx, dy;

    double at(double x, double y) const { return start + dx * x + dy * y; }
    //! The column of the left image that a column of the right image shows
    double leftColumn(double x, double y) const { return (x + start + dy * y) / (1 - dx); }
};

static const Plane PLANES[] = {
    { 8, 0.03, 0.011 }, { 38, -0.037, 0.017 }, { 20, 0.007, 0.029 }, { 36, -0.013, -0.031 }, { 12, 0.019, -0.007 }
};

//! A texture, and its integral along the rows: a pixel is the mean over its area.
class Texture
{
public:
    Texture(bool isNatural, RNG& rng)
        : sums_(planeSize.height, columns + 1, CV_64F, Scalar(0)),
          texture_(planeSize.height, columns, CV_32F, Scalar(0))
    {
        const int octaves = isNatural ? 7 : 1;
        for (int octave = 0; octave < octaves; octave++)
        {
            const double scale = 1 << octave;
            Mat noise(cvCeil(planeSize.height / scale) + 4, cvCeil(columns / (fine * scale)) + 4, CV_32F), enlarged;
            rng.fill(noise, RNG::NORMAL, 0, contrast / std::sqrt(octaves));
            resize(noise, enlarged, Size(), fine * scale, scale, INTER_CUBIC);
            texture_ += enlarged(Rect(Point(), texture_.size()));
        }
        for (int y = 0; y < texture_.rows; y++)
            for (int x = 0; x < columns; x++)
                sums_.at<double>(y, x + 1) = sums_.at<double>(y, x) + texture_.at<float>(y, x);
    }

    //! Mean from one column of the left image to another
    double mean(int y, double begin, double end) const
    {
        return (sumTo(y, end) - sumTo(y, begin)) / (end - begin) / fine;
    }

private:
    enum
    {
        fine = 4, // samples per pixel, along rows
        beside = 64,
        contrast = 40 // standard deviation in grey levels
    };
    const int columns = fine * (planeSize.width + 2 * beside);

    double sumTo(int y, double column) const
    {
        const double x = std::min(std::max(fine * (column + beside), 0.), columns - 1.);
        const int whole = (int)x;
        return sums_.at<double>(y, whole) + (x - whole) * texture_.at<float>(y, whole);
    }

    Mat sums_, texture_;
};

//! Both images of a plane with a texture
static void render(const Plane& plane, const Texture& texture, double noise, RNG& rng, Mat& left, Mat& right)
{
    left.create(planeSize, CV_8U);
    right.create(planeSize, CV_8U);
    const auto level = [&](double mean) { return saturate_cast<uchar>(128 + mean + rng.gaussian(noise)); };
    for (int y = 0; y < left.rows; y++)
        for (int x = 0; x < left.cols; x++)
        {
            left.at<uchar>(y, x) = level(texture.mean(y, x - 0.5, x + 0.5));
            right.at<uchar>(y, x) = level(texture.mean(y, plane.leftColumn(x - 0.5, y), plane.leftColumn(x + 0.5, y)));
        }
}

//! Errors by the fraction of the true disparity
class FractionErrors
{
public:
    FractionErrors() : sums_(2 * binsOfPixel), counts_(2 * binsOfPixel), squares_(0), whole_(0), judged_(0), inside_(0)
    {
    }

    void add(double disparity, double truth)
    {
        judged_++;
        const double error = disparity - truth;
        if (!(std::abs(error) < outlier))
            return;
        inside_++;
        squares_ += error * error;
        whole_ += std::abs(disparity - std::floor(disparity + 0.5)) < 1. / 32;
        const int bin = (int)std::floor(truth * binsOfPixel) % (2 * binsOfPixel);
        sums_[bin] += error;
        counts_[bin]++;
    }

    //! Between the largest and the smallest mean error of a fraction of this period, 1 or 2 pixels
    double peakToPeak(int period) const
    {
        double low = outlier, high = -outlier;
        for (int bin = 0; bin < period * binsOfPixel; bin++)
        {
            double sum = sums_[bin], count = counts_[bin];
            if (period == 1)
            {
                sum += sums_[bin + binsOfPixel];
                count += counts_[bin + binsOfPixel];
            }
            low = std::min(low, sum / std::max(count, 1.));
            high = std::max(high, sum / std::max(count, 1.));
        }
        return high - low;
    }

    //! Share of whole disparities, relative to that of the other fractions in 1/16 if all were as frequent
    double wholeShare() const { return 16. * whole_ / std::max(inside_, 1.); }
    double rms() const { return std::sqrt(squares_ / std::max(inside_, 1.)); }
    double mismatches() const { return 100 * (judged_ - inside_) / std::max(judged_, 1.); }

private:
    std::vector<double> sums_, counts_;
    double squares_, whole_, judged_, inside_;
};

static Table measure(const String& texture, double noise, const std::vector<Method>& methods)
{
    std::vector<FractionErrors> errors(methods.size());
    RNG rng(1);
    for (const Plane& plane : PLANES)
    {
        Mat left, right, colorLeft, colorRight;
        render(plane, Texture(texture == "natural", rng), noise, rng, left, right);
        cvtColor(left, colorLeft, COLOR_GRAY2BGR);
        cvtColor(right, colorRight, COLOR_GRAY2BGR);
        for (size_t m = 0; m < methods.size(); m++)
        {
            const Ptr<StereoMatcher> matcher = methods[m].create(Range(0, planeDisparities));
            const std::array<Mat, 2> images = imagesFor(methods[m], colorLeft, colorRight);
            const Mat disparity = matchDensely(methods[m], *matcher, images[0], images[1]);
            for (int y = margin; y < left.rows - margin; y++)
                for (int x = planeDisparities + margin; x < left.cols - margin; x++)
                    errors[m].add(disparity.at<float>(y, x), plane.at(x, y));
        }
    }
    Table table;
    table.title = texture + format(" texture, noise %g", noise);
    table.header = { "method", "bias px", "bias over 2 px", "whole disparities", "rms px", "mismatches %" };
    for (size_t m = 0; m < methods.size(); m++)
    {
        table.addRow(methods[m].name);
        table.addNumber(errors[m].peakToPeak(1), "%.3f");
        table.addNumber(errors[m].peakToPeak(2), "%.3f");
        table.addNumber(errors[m].wholeShare());
        table.addNumber(errors[m].rms(), "%.3f");
        table.addNumber(errors[m].mismatches());
    }
    return table;
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    setThreads(parser);
    const std::vector<Method> methods = selectMethods("methods", parser.get<String>("methods"));
    const std::vector<String> textures = splitList("textures", parser.get<String>("textures"));
    const double noise = getNumber(parser, "noise", 0, 64);
    for (const String& texture : textures)
        if (texture != "natural" && texture != "fine")
            fail("--textures: unknown texture '" + texture + "', there are: natural, fine");
    for (const String& texture : textures)
        std::cout << toMarkdown(measure(texture, noise, methods)) << std::endl;
    return 0;
}

int main(int argc, char** argv)
{
    return runProgram(
        argc, argv, KEYS + TUNABLE_KEYS,
        "Errors of stereo matchers by the fraction of the true disparity, on generated slanted planes.\n"
        "bias: between the largest and the smallest mean error of a fraction of one pixel, or of two pixels.\n"
        "whole disparities: how often they are found, 1 if as often as any other sixteenth of a pixel.\n"
        "Exit status: 0 if all is well, 1 on errors.\n",
        {}, 0, run);
}
