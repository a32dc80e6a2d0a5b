// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "harmless_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "opencv2/imgproc.hpp"

#include "command_line.hpp"

using namespace cv;

namespace hdp_tools {

HarmlessChange::HarmlessChange()
    : left(0), top(0), move(0), scale(1), isFlipped(false), isMirrored(false), moreDisparities(0)
{
}

const char* const ALL_CHANGES = "noise.5,gamma1.05,gamma.95,jpeg95,left1,left2,left4,left8,top1,top2,top4,move1,"
                                "scale.98,flip,mirror,range1,range16,bits12";

namespace {

//! Grey levels of 8 + bits bits, from colours whose bits below the eighth are random
ImageChange addRandomBits(int bits)
{
    return [bits](const Mat& image, RNG& rng) {
        Mat changed, random(image.size(), CV_16UC3), grey;
        image.convertTo(changed, CV_16U, 1 << bits);
        rng.fill(random, RNG::UNIFORM, 0, 1 << bits);
        cvtColor(changed + random, grey, COLOR_BGR2GRAY);
        return grey;
    };
}

//! A whole number from low to high
bool isWhole(double number, int low, int high)
{
    return number >= low && number <= high && number == std::floor(number);
}

//! The change of a name, without it; the number is what follows the name's letters, not a number if there is none.
bool makeChange(const String& letters, double number, HarmlessChange& made)
{
    const bool hasNumber = !std::isnan(number);
    if (letters == "clean" || letters == "flip" || letters == "mirror")
    {
        made.isFlipped = letters == "flip";
        made.isMirrored = letters == "mirror";
        return !hasNumber;
    }
    if (letters == "noise" && number > 0)
        made.levels = addNoise(number);
    else if (letters == "gamma" && number > 0)
        made.levels = changeLevels([=](double value) { return 255 * std::pow(value / 255, number); });
    else if (letters == "jpeg" && isWhole(number, 1, 100))
        made.levels = compress((int)number);
    else if (letters == "left" && isWhole(number, 1, 1000))
        made.left = (int)number;
    else if (letters == "top" && isWhole(number, 1, 1000))
        made.top = (int)number;
    else if (letters == "move" && isWhole(number, 1, 1000))
        made.move = (int)number;
    else if (letters == "scale" && number >= 0.1 && number <= 4)
        made.scale = number;
    else if (letters == "range" && isWhole(number, 1, 1000))
        made.moreDisparities = (int)number;
    else if (letters == "bits" && isWhole(number, 8, 16))
        made.levels = addRandomBits((int)number - 8);
    else
        return false;
    return true;
}

//! FNV-1a: the same on every machine, unlike std::hash
uint64 seedOf(const String& text)
{
    uint64 seed = 14695981039346656037u;
    for (const char c : text)
        seed = (seed ^ (uchar)c) * 1099511628211u;
    return seed;
}

Size sizeOf(const HarmlessChange& change, Size size)
{
    return Size(std::max(cvRound(size.width * change.scale), 1), std::max(cvRound(size.height * change.scale), 1));
}

//! The columns and rows of the pair that the changed one has
Rect keptRect(const HarmlessChange& change, Size size)
{
    if (change.left + change.move >= size.width || change.top + change.move >= size.height)
        fail(format("the change %s leaves nothing of %d x %d pixels", change.name.c_str(), size.width, size.height));
    return Rect(change.left, change.top, size.width - change.left - change.move,
                size.height - change.top - change.move);
}

Mat changeImage(const HarmlessChange& change, const Mat& image, RNG& rng)
{
    Mat changed = image(keptRect(change, image.size())).clone();
    if (change.move > 0)
        copyMakeBorder(changed, changed, change.move, 0, change.move, 0, BORDER_REPLICATE);
    if (change.scale != 1)
        resize(changed, changed, sizeOf(change, changed.size()), 0, 0, INTER_CUBIC);
    if (change.isFlipped || change.isMirrored)
        flip(changed, changed, change.isMirrored ? 1 : 0);
    return change.levels ? change.levels(changed, rng) : changed;
}

//! The pixel of a scaled picture at each pixel of the whole one
Mat enlarge(const Mat& picture, Size size)
{
    Mat enlarged(size, picture.type());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const int row = std::min((int)((y + 0.5) * picture.rows / size.height), picture.rows - 1),
                      column = std::min((int)((x + 0.5) * picture.cols / size.width), picture.cols - 1);
            std::copy_n(picture.ptr(row, column), picture.elemSize(), enlarged.ptr(y, x));
        }
    return enlarged;
}

Mat restore(const HarmlessChange& change, const Mat& picture, Size size, double cutOff)
{
    const Rect kept = keptRect(change, size);
    Mat restored(size, picture.type(), Scalar::all(cutOff)), whole = picture;
    if (change.isFlipped || change.isMirrored)
        flip(picture, whole, change.isMirrored ? 1 : 0);
    if (change.scale != 1)
        whole = enlarge(whole, size);
    whole(Rect(Point(change.move, change.move), kept.size())).copyTo(restored(kept));
    return restored;
}

//! Masks of the right image's pixels that count, and their truth
void mirrorTruth(const Pair& pair, Pair& mirrored)
{
    Mat leftTruth, rightTruth, judged;
    if (pair.rightTruth.empty())
    {
        const Mat& visible = pair.judgedNonOccluded.empty() ? pair.judged : pair.judgedNonOccluded;
        mirrored.truth = warpToRight(pair.truth, visible);
        mirrored.judged = knownPixels(mirrored.truth);
        return;
    }
    flip(pair.truth, leftTruth, 1);
    flip(pair.rightTruth, rightTruth, 1);
    // As for the left image: the maps that are whole numbers agree exactly.
    judged = nonOccludedPixels(rightTruth, leftTruth, pair.protocol == Pair::BAD ? 1 : 0);
    mirrored.truth = pair.rightTruth;
    flip(judged, mirrored.judged, 1);
}

} // namespace

std::vector<HarmlessChange> selectChanges(const String& option, const String& list)
{
    std::vector<HarmlessChange> changes;
    for (const String& name : splitList(option, list))
    {
        const size_t letters = std::min(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), name.size());
        const String number = name.substr(letters);
        char* end = nullptr;
        const double value = std::strtod(number.c_str(), &end);
        HarmlessChange made;
        made.name = name;
        if (*end != 0 || !makeChange(name.substr(0, letters), number.empty() ? std::nan("") : value, made))
            fail("--" + option + " knows no change '" + name + "', only " + ALL_CHANGES +
                 ", these with other numbers, and clean");
        if (std::none_of(changes.begin(), changes.end(),
                         [&](const HarmlessChange& other) { return other.name == name; }))
            changes.push_back(made);
    }
    return changes;
}

std::vector<HarmlessChange> selectChanges(const CommandLineParser& parser)
{
    if (!parser.has("changes"))
        return std::vector<HarmlessChange>();
    const String list = parser.get<String>("changes");
    return selectChanges("changes", list == "true" ? String(ALL_CHANGES) : list); // which an option without a value is
}

Pair changePair(const HarmlessChange& change, const Pair& pair, const String& scene)
{
    Mat left = pair.left, right = pair.right;
    toColors(left, right);
    RNG rng(seedOf(scene + " " + change.name));
    Pair changed;
    changed.protocol = Pair::NO_TRUTH;
    changed.left = changeImage(change, change.isMirrored ? right : left, rng);
    changed.right = changeImage(change, change.isMirrored ? left : right, rng);
    changed.disparities.start = (int)std::floor(pair.disparities.start * change.scale);
    changed.disparities.end = (int)std::ceil(pair.disparities.end * change.scale) + change.moreDisparities;
    return changed;
}

Mat restoreMap(const HarmlessChange& change, const Mat& disparity, Size size)
{
    const Mat restored = restore(change, disparity, size, NO_DISPARITY);
    // The width is a whole number, so its scale is not quite that of the change. No disparity stays infinite.
    return change.scale == 1 ? restored : Mat(restored * ((double)size.width / disparity.cols));
}

Mat restorePicture(const HarmlessChange& change, const Mat& picture, Size size)
{
    return restore(change, picture, size, 0);
}

Mat keptPixels(const HarmlessChange& change, const Mat& disparity)
{
    const Rect kept = keptRect(change, disparity.size());
    Mat pixels = Mat::zeros(disparity.size(), CV_8U);
    pixels(kept).setTo(255);
    if (kept.size() == disparity.size())
        return pixels;
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const float column = (float)x - disparity.at<float>(y, x);
            // What the right image has never shown is as good as before.
            if (column >= 0 && column < disparity.cols && (column < kept.x || column >= kept.br().x))
                pixels.at<uchar>(y, x) = 0;
        }
    return pixels;
}

Pair truthOfChanged(const HarmlessChange& change, const Pair& pair)
{
    Pair judging;
    judging.protocol = pair.protocol;
    judging.disparities = pair.disparities;
    if (pair.protocol == Pair::NO_TRUTH)
        return judging;
    if (change.isMirrored)
        mirrorTruth(pair, judging);
    else
    {
        const Mat kept = keptPixels(change, pair.truth);
        judging.truth = pair.truth;
        judging.judged = pair.judged & kept;
        if (!pair.judgedNonOccluded.empty())
            judging.judgedNonOccluded = pair.judgedNonOccluded & kept;
    }
    if (countNonZero(judging.judged) == 0)
        fail("the change " + change.name + " leaves no pixel that can be judged");
    return judging;
}

Mat warpToRight(const Mat& disparity, const Mat& pixels)
{
    Mat warped(disparity.size(), CV_32F, Scalar(-NO_DISPARITY));
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const float d = disparity.at<float>(y, x);
            const int column = d < NO_DISPARITY ? x - cvRound(d) : -1;
            if (pixels.at<uchar>(y, x) && column >= 0 && column < disparity.cols)
                warped.at<float>(y, column) = std::max(warped.at<float>(y, column), d);
        }
    warped.setTo(NO_DISPARITY, warped == -NO_DISPARITY);
    return warped;
}

} // namespace hdp_tools
