// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "windowed_pair.hpp"

#include "files.hpp"

#include <climits>

#include "opencv2/imgproc.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;

WindowedPair::WindowedPair(const CommandLineParser& parser)
    : left_(open(parser, "@left", "LEFT")), right_(open(parser, "@right", "RIGHT")),
      leftMask_(open(parser, "left-mask", "--left-mask")), rightMask_(open(parser, "right-mask", "--right-mask")),
      smallest_(open(parser, "smallest", "--smallest")), largest_(open(parser, "largest", "--largest")),
      prior_(open(parser, "prior", "--prior"))
{
    if (CV_MAT_DEPTH(left_.windows->type()) != CV_MAT_DEPTH(right_.windows->type()))
        CV_Error(Error::StsUnmatchedFormats, "RIGHT must have the type of LEFT");
}

WindowedPair::File WindowedPair::open(const CommandLineParser& parser, const char* option, const char* name)
{
    if (!parser.has(option))
        return File();
    const File file = { parser.get<String>(option), openImage(parser.get<String>(option)) };
    const Size found = file.windows->size();
    if (size_.empty())
        size_ = found;
    if (found != size_)
        CV_Error(Error::StsUnmatchedSizes, format("%s must have the size of LEFT, %d x %d, not %d x %d", name,
                                                  size_.width, size_.height, found.width, found.height));
    return file;
}

int WindowedPair::bytesInMemory() const
{
    int bytes = 0;
    for (const File& file : files())
        bytes += file.windows ? file.windows->bytesInMemory() : 0;
    return bytes;
}

std::vector<String> WindowedPair::readWhole() const
{
    std::vector<String> paths;
    for (const File& file : files())
        if (file.windows && file.windows->bytesInMemory() > 0)
            paths.push_back(file.path);
    return paths;
}

//! A part of an image, and where it has data: by its own file and by that of --left-mask or --right-mask; everywhere
//! if empty
void WindowedPair::readSide(const File& image, const File& maskFile, const Rect& part, Mat& pixels, Mat& mask)
{
    pixels = image.windows->read(part, mask);
    if (!maskFile.windows)
        return;
    Mat ofMask, given = maskFile.windows->read(part, ofMask);
    if (given.channels() > 1)
        cvtColor(given, given, COLOR_BGR2GRAY);
    mask = joinMasks(given != 0, mask);
}

PairPart WindowedPair::read(const Rect& part) const
{
    PairPart pair;
    readSide(left_, leftMask_, part, pair.left, pair.leftMask);
    readSide(right_, rightMask_, part, pair.right, pair.rightMask);
    makeAlike(pair.left, pair.right);
    return pair;
}

PairPart WindowedPair::reduced(int times) const
{
    const Size small(size().width >> times, size().height >> times);
    PairPart pair = { Mat(small, type()), Mat(small, type()), Mat(small, CV_8U), Mat(small, CV_8U) };
    const int rows = std::max(256 >> times, 1);
    for (int y = 0; y < small.height; y += rows)
    {
        const int count = std::min(rows, small.height - y);
        const PairPart band = read(Rect(0, y << times, small.width << times, count << times));
        const auto reduce = [&](const Mat& from, const Mat& to) {
            if (from.empty())
                to.rowRange(y, y + count).setTo(255);
            else
                resize(from, to.rowRange(y, y + count), Size(small.width, count), 0, 0, INTER_AREA);
        };
        reduce(band.left, pair.left);
        reduce(band.right, pair.right);
        reduce(band.leftMask, pair.leftMask);
        reduce(band.rightMask, pair.rightMask);
    }
    for (Mat* const mask : { &pair.leftMask, &pair.rightMask })
    {
        *mask = *mask == 255; // of pixels that all have data
        if (countNonZero(*mask) == (int)mask->total())
            mask->release();
    }
    return pair;
}

Mat WindowedPair::readMap(const File& map, const Rect& part)
{
    if (!map.windows)
        return Mat();
    Mat mask;
    const Mat image = map.windows->read(part, mask);
    return toDisparity(image, mask, map.path);
}

//! Calls use(smallest, largest) for bands of rows, from above, until it is false. Returns whether it never was.
template <typename Use> bool WindowedPair::forLimits(const Use& use) const
{
    const int rows = 256;
    for (int y = 0; y < size_.height; y += rows)
    {
        const Rect band = Rect(0, y, size_.width, rows) & Rect(Point(), size_);
        if (!use(readMap(smallest_, band), readMap(largest_, band)))
            return false;
    }
    return true;
}

void WindowedPair::checkLimits() const
{
    if (!smallest_.windows && !largest_.windows)
        return;
    const int limit = (SHRT_MAX + 1) / StereoMatcher::DISP_SCALE; // of disparities in CV_16S
    int64 less = 0, beyond = 0;
    forLimits([&](const Mat& least, const Mat& most) {
        less += least.empty() || most.empty() ? 0 : countNonZero(most < least);
        beyond += least.empty() ? 0 : countNonZero(least >= limit);
        beyond += most.empty() ? 0 : countNonZero(most < -limit);
        return true;
    });
    if (less > 0)
        CV_Error(Error::StsBadArg,
                 format("--largest must not be less than --smallest, as it is in %lld pixels", (long long)less));
    if (beyond > 0)
        CV_Error(Error::StsOutOfRange,
                 format("--smallest must be below %d and --largest at least %d, as they are not in %lld pixels", limit,
                        -limit, (long long)beyond));
}

bool WindowedPair::limitsAll(double& smallest, double& largest) const
{
    if (!smallest_.windows || !largest_.windows)
        return false;
    bool isFirst = true;
    return forLimits([&](const Mat& least, const Mat& most) {
        if (!checkRange(least) || !checkRange(most)) // NaN
            return false;
        double first, last;
        minMaxLoc(least, &first, nullptr);
        minMaxLoc(most, nullptr, &last);
        smallest = isFirst ? first : std::min(smallest, first);
        largest = isFirst ? last : std::max(largest, last);
        isFirst = false;
        return true;
    });
}

void WindowedPair::setKnownDisparities(const CommandLineParser& parser, const Rect& part, HDPTreeMatcher& matcher) const
{
    ::setKnownDisparities(parser, readMap(smallest_, part), readMap(largest_, part), readMap(prior_, part), matcher);
}
