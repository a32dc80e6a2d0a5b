// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "blank_borders.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(int, maxBlack, 2, "levels of 8 bits", "of borders, as JPEG leaves them: more takes dark scenes for them");
HDP_TUNABLE(double, shareOfMean, 0.25, "share of the mean",
            "that ends a border: more takes shadows for it, less leaves what JPEG blurs at its end");
HDP_TUNABLE(int, mostMixed, 10, "pixels", "between black and that level, as in a block of JPEG: shadows have more");
HDP_TUNABLE(double, minSharp, 0.7, "share of the rows",
            "of a border that end at that level: others end in dark parts of the scene");
HDP_TUNABLE(int, span, 8, "rows", "between three whose ends lie on a line: fewer see a line in anything");
HDP_TUNABLE(double, minSmooth, 0.9, "share of these", "of a border that do, but for rounding: other things are rough");
HDP_TUNABLE(int, sidesPerBorder, 4, "lengths of a side",
            "of which one is in a border: less takes black things at the sides for it");
HDP_TUNABLE(int, pixelsPerBorder, 100, "pixels", "of an image, of which one is in borders: fewer do no harm");
HDP_TUNABLE(double, mostBlank, 0.5, "share of an image", "that is in borders: more is a dark scene");
HDP_TUNABLE(int, minSide, 32, "pixels", "of an image: of fewer, a percent is single pixels");

//! The highest level that is black
int blackOf(const Mat& image) { return image.depth() == CV_8U ? maxBlack : 0; }

//! Of the channels of a pixel
int brightest(const Mat& image, const Point& p)
{
    if (image.depth() == CV_16U)
        return image.at<ushort>(p);
    const uchar* const pixel = image.ptr(p.y) + (ptrdiff_t)p.x * image.channels();
    return image.channels() == 1 ? *pixel : std::max(pixel[0], std::max(pixel[1], pixel[2]));
}

//! A side of an image, and its rows or columns from there to the opposite side
struct Side
{
    Point first, along; // its pixels
    int count;
    Point inwards; // from a pixel of a row or column to the next
    int length;
    bool isCut, isCutOpposite, isCutBefore, isCutBehind; // whether the image goes on there, and beside its ends
};

//! The border of an image that begins at one of its sides
class SideBorder
{
public:
    SideBorder(const Mat& image, double level, const Side& side)
        : image_(image), level_(level), side_(side), lines_(side.count)
    {
        if (side.isCut)
            return;
        for (int i = 0; i < side.count; ++i)
            lines_[i] = findLine(side.first + side.along * i);
        for (int begin = 0, end; begin < side.count; begin = end)
        {
            end = begin + 1;
            while (end < side.count && (lines_[end].blank > 0) == (lines_[begin].blank > 0))
                ++end;
            if (!isBorder(begin, end))
                std::fill(lines_.begin() + begin, lines_.begin() + end, Line());
        }
    }

    //! Masks rows or columns up to the ends that they have.
    void mask(Mat& mask) const
    {
        for (size_t i = 0; i < lines_.size(); ++i)
            for (int k = 0; k < lines_[i].blank && !lines_[i].isOpen; ++k)
                mask.at<uchar>(side_.first + side_.along * (int)i + side_.inwards * k) = 0;
    }

    //! Whether a row or column is black up to the opposite side. Where the border ends, the others tell.
    bool isOpen(int i) const { return lines_[i].isOpen; }

private:
    //! A row or column
    struct Line
    {
        int blank; // pixels, with those that are mixed
        bool isSharp, isOpen;
    };

    //! first: its pixel at the side
    Line findLine(const Point& first) const
    {
        const auto brightness = [&](int i) { return brightest(image_, first + side_.inwards * i); };
        const int length = side_.length;
        int black = 0;
        while (black < length && brightness(black) <= blackOf(image_))
            ++black;
        if (black == 0 || black == length)
            return { black, true, black > 0 && !side_.isCutOpposite };
        const int last = std::min(black + mostMixed, length - 1);
        int end = black;
        while (end < last && brightness(end) < level_)
            ++end;
        return brightness(end) >= level_ ? Line({ end + 1, true, false }) : Line({ black, false, false });
    }

    //! Whether black lines are one. What is too short, or has no sharp and smooth outline, is a part of the scene. One
    //! that reaches no corner is shallow, from nothing to nothing: that is how distortion bends the sides of an image.
    bool isBorder(int begin, int end) const
    {
        // What is black up to the end of a tile ends beyond it.
        const auto endsHere = [this](int i) { return lines_[i].isSharp && lines_[i].blank < side_.length; };
        int ending = 0, sharp = 0, compared = 0, smooth = 0;
        for (int i = begin; i < end; ++i)
        {
            ending += !lines_[i].isOpen;
            sharp += lines_[i].isSharp && !lines_[i].isOpen;
            if (i < begin + span || i + span >= end || !endsHere(i - span) || !endsHere(i) || !endsHere(i + span))
                continue;
            ++compared;
            const int bend = lines_[i - span].blank + lines_[i + span].blank - 2 * lines_[i].blank;
            smooth += std::abs(bend) <= 2; // each is rounded
        }
        const bool goesOn = (begin == 0 && side_.isCutBefore) || (end == side_.count && side_.isCutBehind);
        const bool isShallow = std::max(lines_[begin].blank, lines_[end - 1].blank) <= mostMixed,
                   reachesCorner = begin == 0 || end == side_.count;
        return (goesOn || ending * sidesPerBorder >= side_.count) && sharp >= minSharp * ending &&
               smooth >= minSmooth * compared && (reachesCorner || isShallow);
    }

    const Mat& image_;
    const double level_;
    const Side side_;
    std::vector<Line> lines_;
};

//! Whether one of some pixels of the sides is black: every border has one of them, as it is long enough.
bool hasBlackSide(const Mat& image)
{
    const int parts = 2 * sidesPerBorder;
    for (int i = 0; i <= parts; ++i)
    {
        const int right = image.cols - 1, bottom = image.rows - 1, x = right * i / parts, y = bottom * i / parts;
        for (const Point& p : { Point(x, 0), Point(x, bottom), Point(0, y), Point(right, y) })
            if (brightest(image, p) <= blackOf(image))
                return true;
    }
    return false;
}

//! Over all pixels, and red, green and blue
double meanLevel(const Mat& image)
{
    const Scalar means = mean(image);
    return image.channels() == 1 ? means[0] : (means[0] + means[1] + means[2]) / 3;
}

//! Whether these are borders: neither so few that they do no harm, nor a dark scene
bool areBorders(const Mat& mask)
{
    const double total = (double)mask.total(), blank = total - countNonZero(mask);
    return blank * pixelsPerBorder > total && blank < mostBlank * total;
}

} // namespace

double findBorders(const Mat& left, const Mat& right, PairMasks& masks)
{
    if (std::min(left.cols, left.rows) < minSide || (!hasBlackSide(left) && !hasBlackSide(right)))
        return 0;
    const double least = left.depth() == CV_8U ? 4 * maxBlack : 1;
    const double level = std::max((meanLevel(left) + meanLevel(right)) / 2 * shareOfMean, least);
    PairMasks found;
    maskBorders(left, level, ImageFrame(left.size()), found.left);
    maskBorders(right, level, ImageFrame(right.size()), found.right);
    if (!areBorders(found.left) && !areBorders(found.right))
        return 0;
    masks = found;
    return level;
}

void maskBorders(const Mat& image, double level, const ImageFrame& frame, Mat& mask)
{
    mask.create(image.size(), CV_8U);
    mask.setTo(Scalar(255));
    const int width = image.cols, height = image.rows;
    const Point end = frame.origin + Point(width, height);
    const bool isCutLeft = frame.origin.x > 0, isCutRight = end.x < frame.whole.width;
    const bool isCutAbove = frame.origin.y > 0, isCutBelow = end.y < frame.whole.height;
    const Point x(1, 0), y(0, 1);
    const SideBorder left(image, level,
                          { Point(), y, height, x, width, isCutLeft, isCutRight, isCutAbove, isCutBelow }),
        right(image, level, { x * (width - 1), y, height, -x, width, isCutRight, isCutLeft, isCutAbove, isCutBelow }),
        above(image, level, { Point(), x, width, y, height, isCutAbove, isCutBelow, isCutLeft, isCutRight }),
        below(image, level, { y * (height - 1), x, width, -y, height, isCutBelow, isCutAbove, isCutLeft, isCutRight });
    for (const SideBorder* border : { &left, &right, &above, &below })
        border->mask(mask);
    // Where black rows cross black columns, in a corner
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width && (left.isOpen(row) || right.isOpen(row)); ++column)
            if (above.isOpen(column) || below.isOpen(column))
                mask.at<uchar>(row, column) = 0;
}

}}} // namespace cv::stereo::hdp
