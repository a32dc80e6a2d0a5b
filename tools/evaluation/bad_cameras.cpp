// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bad_cameras.hpp"

#include <cmath>
#include <cstdlib>
#include <map>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include "command_line.hpp"

using namespace cv;

namespace hdp_tools {

ImageChange changeLevels(const std::function<double(double)>& change)
{
    Mat table(1, 256, CV_8U);
    for (int i = 0; i < 256; ++i)
        table.at<uchar>(i) = saturate_cast<uchar>(change(i));
    return [table](const Mat& image, RNG&) {
        Mat changed;
        LUT(image, table, changed);
        return changed;
    };
}

ImageChange addNoise(double deviation)
{
    return [deviation](const Mat& image, RNG& rng) { return addNoise(image, deviation, rng); };
}

Mat addNoise(const Mat& image, double deviation, RNG& rng)
{
    if (deviation == 0)
        return image;
    Mat noise(image.size(), CV_MAKETYPE(CV_32F, image.channels())), noisy;
    rng.fill(noise, RNG::NORMAL, 0, image.depth() == CV_16U ? 257 * deviation : deviation);
    add(image, noise, noisy, noArray(), image.depth());
    return noisy;
}

ImageChange compress(int quality)
{
    return [quality](const Mat& image, RNG&) {
        std::vector<uchar> bytes;
        imencode(".jpg", image, bytes, std::vector<int>{ IMWRITE_JPEG_QUALITY, quality });
        return imdecode(bytes, IMREAD_COLOR);
    };
}

namespace {

Mat same(const Mat& image, RNG&) { return image; }

Mat darken(const Mat& image, RNG& rng)
{
    Mat table(1, 256, CV_8U), changed;
    for (int i = 0; i < 256; ++i)
        table.at<uchar>(i) = (uchar)(i / 8);
    LUT(image, table, changed);
    return addNoise(2)(changed, rng);
}

//! Pixels that are black or white
ImageChange defects(double percent)
{
    return [percent](const Mat& image, RNG& rng) {
        Mat changed = image.clone();
        for (int i = cvRound(percent / 100 * (double)image.total()); i > 0; --i)
            changed.at<Vec3b>(rng.uniform(0, image.rows), rng.uniform(0, image.cols)) = Vec3b::all(255 * (i % 2));
        return changed;
    };
}

ImageChange blur(double deviation)
{
    return [deviation](const Mat& image, RNG&) {
        Mat changed;
        GaussianBlur(image, changed, Size(), deviation);
        return changed;
    };
}

Mat vignette(const Mat& image, RNG&)
{
    Mat changed = image.clone();
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
        {
            const double u = 2. * x / std::max(image.cols - 1, 1) - 1, v = 2. * y / std::max(image.rows - 1, 1) - 1;
            changed.at<Vec3b>(y, x) *= 1 - 0.35 * (u * u + v * v);
        }
    return changed;
}

//! Row y moves to y + offset + shear * x + stretch * y, from the centre.
ImageChange rows(double offset, double shear, double stretch)
{
    return [=](const Mat& image, RNG&) {
        const double x = image.cols / 2., y = image.rows / 2.;
        const Matx23d move(1, 0, 0, shear, 1 + stretch, offset - shear * x - stretch * y);
        Mat changed;
        warpAffine(image, changed, move, image.size(), INTER_CUBIC, BORDER_REPLICATE);
        return changed;
    };
}

//! What turned cameras show of an image, the left one or the right one: all but black wedges on its sides, so many
//! percent of it wide at one end
std::function<Mat(Size)> shownWithinBorders(double percent, bool isRight)
{
    return [=](const Size& size) {
        const double share = percent / 100;
        const auto corner = [&](double x, double y) {
            return Point(cvRound(x * (size.width - 1)), cvRound(y * (size.height - 1)));
        };
        const std::vector<Point> corners =
            isRight
                ? std::vector<Point>{ corner(0, share), corner(1 - share, 0), corner(1, 1 - share), corner(share, 1) }
                : std::vector<Point>{ corner(share, 0), corner(1, share), corner(1 - share, 1), corner(0, 1 - share) };
        Mat shown(size, CV_8U, Scalar(0));
        fillConvexPoly(shown, corners, Scalar(255));
        return shown;
    };
}

ImageChange keepShown(const std::function<Mat(Size)>& shown)
{
    return [shown](const Mat& image, RNG&) {
        Mat changed(image.size(), image.type(), Scalar(0));
        image.copyTo(changed, shown(image.size()));
        return changed;
    };
}

//! Which numbers a case may have; others leave nothing of an image, or take hours.
struct NumberRange
{
    const char* letters;
    double min, max;
};
const NumberRange numberRanges[] = { { "gain", 0, 100 },  { "gamma", 0.01, 100 }, { "offset", -255, 255 },
                                     { "noise", 0, 255 }, { "defects", 0, 100 },  { "blur", 0.1, 100 },
                                     { "jpeg", 0, 100 },  { "dy", -1000, 1000 },  { "borders", 0, 40 } };

//! The case of a name, without it; the number is what follows the name's letters.
bool makeCase(const String& letters, double number, CameraCase& made)
{
    made.left = made.right = same;
    if (letters == "clean")
        ;
    else if (letters == "gain")
        made.right = changeLevels([=](double value) { return value * number; });
    else if (letters == "gamma")
        made.right = changeLevels([=](double value) { return 255 * std::pow(value / 255, number); });
    else if (letters == "offset")
        made.right = changeLevels([=](double value) { return value + number; });
    else if (letters == "vignette")
        made.right = vignette;
    else if (letters == "noise")
        made.left = made.right = addNoise(number);
    else if (letters == "defects")
        made.left = made.right = defects(number);
    else if (letters == "linear")
        made.left = made.right = changeLevels([](double value) { return 255 * std::pow(value / 255, 2.2); });
    else if (letters == "dark")
        made.left = made.right = darken;
    else if (letters == "blur")
        made.right = blur(number);
    else if (letters == "jpeg")
        made.left = made.right = compress((int)number);
    else if (letters == "borders")
    {
        made.shownLeft = shownWithinBorders(number, false);
        made.shownRight = shownWithinBorders(number, true);
        made.left = keepShown(made.shownLeft);
        made.right = keepShown(made.shownRight);
    }
    else if (letters == "dy")
        made.right = rows(number, 0, 0);
    else if (letters == "shear")
        made.right = rows(0, 0.0052, 0);
    else if (letters == "stretch")
        made.right = rows(0.7, 0.003, 0.004);
    else
        return false;
    return true;
}

} // namespace

const char* const ALL_CASES =
    "clean,gain.7,gain.5,gamma1.5,offset30,vignette,noise2,noise5,noise15,defects.5,dark,linear,blur1.5,jpeg30,"
    "borders6,dy.5,dy1,dy2,dy-3,shear,stretch";

std::vector<CameraCase> selectCases(const String& option, const String& list)
{
    std::vector<CameraCase> cases;
    for (const String& name : splitList(option, list))
    {
        const size_t length = std::min(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), name.size());
        const String letters = name.substr(0, length), number = name.substr(length);
        char* end = nullptr;
        const double value = std::strtod(number.c_str(), &end);
        CameraCase made;
        made.name = name;
        bool hasNumber = false;
        for (const NumberRange& range : numberRanges)
            if (letters == range.letters)
            {
                hasNumber = true;
                if (!number.empty() && !(value >= range.min && value <= range.max))
                    fail(format("--%s: the number of '%s' must be %g to %g", option.c_str(), name.c_str(), range.min,
                                range.max));
            }
        if (*end != 0 || hasNumber == number.empty() || !makeCase(letters, value, made))
            fail("--" + option + " knows no case '" + name + "', only " + ALL_CASES + ", and these with other numbers");
        bool isNew = true;
        for (const CameraCase& other : cases)
            isNew = isNew && other.name != name;
        if (isNew)
            cases.push_back(made);
    }
    return cases;
}

} // namespace hdp_tools
