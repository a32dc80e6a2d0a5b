// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../interrupts.hpp"
#include "files.hpp"
#include "options.hpp"
#include "windowed_pair.hpp"

#include <cmath>
#include <iostream>
#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::PairModel;

namespace {

// Pixels of the reduced pair that tells the rows and the light: alignment looks at 600000
const double overviewPixels = 3e6;

const int margin = 128; // pixels that scanlines come from, beside what disparities need

//! Memory that a matcher takes, in bytes per pixel, at most; see BENCHMARK.md
double bytesPerPixel(const String& preset)
{
    return preset == "ultrafast" ? 70 : preset == "fast" ? 85 : preset == "quality" ? 120 : 200;
}

//! How a pair is cut
class Tiling
{
public:
    Tiling(Size size, const HDPTreeMatcher& matcher, int layers, double pixels) : size_(size)
    {
        const int step = 48 << std::max(layers - 3, 0); // of the layers' pixels; TIFF needs a multiple of 16
        const auto toGrid = [=](int count) { return (count + step - 1) / step * step; };
        const int min = matcher.getMinDisparity(), largest = min + matcher.getNumDisparities() - 1;
        before_ = Size(toGrid(std::max(largest, 0) + margin), toGrid(margin));
        after_ = Size(std::max(-min, 0) + margin, margin);
        const Size beside = before_ + after_;
        const int most = std::min(SHRT_MAX - std::max(beside.width, beside.height), std::max(size.width, size.height));
        side_ = toGrid(most) > SHRT_MAX - beside.width ? most / step * step : toGrid(most);
        const auto largestTile = [&] {
            return Size(std::min(side_ + beside.width, size.width), std::min(side_ + beside.height, size.height));
        };
        const auto fits = [&] { return (double)largestTile().width * largestTile().height <= pixels; };
        while (side_ > step && !fits())
            side_ -= step;
        if (!fits())
            CV_Error(Error::StsOutOfRange,
                     format("--memory is too little for a tile of %d x %d pixels with its margins", largestTile().width,
                            largestTile().height));
    }

    int side() const { return side_; }
    int count() const { return columns() * ((size_.height + side_ - 1) / side_); }
    //! What a tile is for
    Rect inside(int i) const
    {
        return Rect(i % columns() * side_, i / columns() * side_, side_, side_) & Rect(Point(), size_);
    }
    //! With its margins
    Rect whole(int i) const
    {
        const Rect part = inside(i);
        return Rect(part.tl() - Point(before_), part.size() + before_ + after_) & Rect(Point(), size_);
    }

private:
    int columns() const { return (size_.width + side_ - 1) / side_; }

    Size size_, before_, after_;
    int side_;
};

//! Pixels of a tile that fit into --memory, which are some at least
double affordedPixels(const CommandLineParser& parser, double otherBytes)
{
    const double memory = numberOf(parser, "memory") * (1 << 20), fixed = 72 << 20; // of the program itself
    const double perPixel = bytesPerPixel(parser.get<String>("preset")) + 16;       // and images, and map
    const double pixels = (memory - fixed - otherBytes) / perPixel;
    if (!(pixels > 256 * 256))
        CV_Error(Error::StsOutOfRange, format("--memory must be more than %.0f MiB",
                                              std::ceil((fixed + otherBytes + 256 * 256 * perPixel) / (1 << 20))));
    return pixels;
}

//! A matcher as the options say, with the model of this pair, estimated by itself
Ptr<HDPTreeMatcher> matchAlone(const CommandLineParser& parser, int width, const PairPart& pair, int minDisparity,
                               int numDisparities)
{
    const Ptr<HDPTreeMatcher> matcher = createPlainMatcher(parser, width);
    matcher->setPairModel(PairModel());
    matcher->setMasks(pair.leftMask, pair.rightMask);
    matcher->setMinDisparity(minDisparity);
    matcher->setNumDisparities(numDisparities);
    computeDisparity(*matcher, pair.left, pair.right);
    return matcher;
}

//! How often images are halved to be seen at once
int timesHalved(Size size, double pixels)
{
    int times = 0;
    while ((double)(size.width >> times) * (size.height >> times) > std::min(overviewPixels, pixels))
        ++times;
    return times;
}

//! --num-disparities=0: that of --findings, of --smallest and --largest if they limit all pixels, or of the reduced pair
void takeRange(const CommandLineParser& parser, const WindowedPair& pair, double pixels, HDPTreeMatcher& matcher)
{
    if (parser.has("findings"))
    {
        const PairModel model = findingsOf(parser);
        matcher.setMinDisparity(model.minDisparity);
        matcher.setNumDisparities(model.numDisparities);
    }
    else
    {
        double first = 0, last = 0;
        if (!pair.limitsAll(first, last))
        {
            const int times = timesHalved(pair.size(), pixels);
            const HDPTreeMatcher::Findings found =
                matchAlone(parser, pair.size().width, pair.reduced(times), 0, 0)->getFindings();
            first = std::ldexp(found.minDisparity, times);
            last = std::ldexp(found.minDisparity + found.numDisparities, times) - 1;
        }
        const double most = std::min(pair.size().width - 1, 2045); // as a matcher finds in the whole
        const auto limited = [=](double disparity) { return std::max(std::min(disparity, most), -most); };
        matcher.setMinDisparity(cvFloor(limited(first)));
        matcher.setNumDisparities(cvCeil(limited(last)) - matcher.getMinDisparity() + 1);
    }
    std::cout << format("%-11sdisparities %d..%d\n", "found", matcher.getMinDisparity(),
                        matcher.getMinDisparity() + matcher.getNumDisparities() - 1);
}

//! What all tiles are matched with: --findings, or rows and light of the reduced pair and the rest of a part in the
//! middle. layers: receives the number of layers.
PairModel findModel(const CommandLineParser& parser, const WindowedPair& pair, const HDPTreeMatcher& matcher,
                    double pixels, int& layers)
{
    const Size size = pair.size();
    const int times = timesHalved(size, pixels);
    const int min = matcher.getMinDisparity(), count = matcher.getNumDisparities();
    const int side = (int)std::sqrt(std::min(overviewPixels, pixels));
    const Rect all(Point(), size), middle = Rect((size.width - side) / 2, (size.height - side) / 2, side, side) & all;
    const Rect part = times == 0 ? all : middle;
    Ptr<HDPTreeMatcher> ofPart = matchAlone(parser, size.width, pair.read(part), min, count);
    layers = (int)ofPart->getFindings().searchRatios.size();
    if (parser.has("findings"))
        return findingsOf(parser);
    const PairModel found = ofPart->getPairModel();
    ofPart.release(); // its memory, before that of the next one
    if (times == 0)
        return found;

    PairModel model = matchAlone(parser, size.width, pair.reduced(times), min >> times, (count >> times) + 1)
                          ->getPairModel()
                          .enlarged(times, size.width, size.height);
    if (found.noise > 0)
    {
        const double contrast = model.white - model.black; // which noise is told of
        model.noise = found.noise * (contrast > 0 ? (found.white - found.black) / contrast : 1);
        model.noiseLayer = found.noiseLayer;
        model.rowError = found.rowError;
    }
    model.leftBlockStart = (found.leftBlockStart + part.x) % 8;
    model.leftBlockStep = found.leftBlockStep;
    model.rightBlockStart = (found.rightBlockStart + part.x) % 8;
    model.rightBlockStep = found.rightBlockStep;
    return model;
}

void checkTileOptions(const CommandLineParser& parser)
{
    for (const char* option : { "picture", "truth", "point-cloud", "compare", "batch", "calibration", "calibration2",
                                "depth", "sigma", "confidence", "reasons" })
        if (parser.has(option))
            CV_Error(Error::StsBadArg, format("--%s does not go with --tiles", option));
    if (!parser.has("@left") || !parser.has("@right") || parser.has("@out") == parser.has("output"))
        CV_Error(Error::StsBadArg, "--tiles needs LEFT RIGHT OUT");
    if (!(numberOf(parser, "memory") > 0))
        CV_Error(Error::StsBadArg, "--memory must be above 0");
    if (!(numberOf(parser, "prior-sigma") >= 0)) // else a tile with a point of the prior would tell
        CV_Error(Error::StsBadArg, "--prior-sigma must be >= 0");
    checkOutputs(parser);
}

//! Tiles are of the images that --findings were found in, whose levels have as many bits.
void checkFindings(const CommandLineParser& parser, const WindowedPair& pair)
{
    if (!parser.has("findings"))
        return;
    const String path = parser.get<String>("findings");
    const PairModel model = findingsOf(parser);
    const Size size(model.width, model.height), tile(model.tileWidth, model.tileHeight);
    if (tile != size)
        CV_Error(Error::StsBadArg, "--findings=" + path + " is of a tile; it must be of whole images");
    if (size != pair.size())
        CV_Error(Error::StsUnmatchedSizes,
                 format("--findings=%s is of images of %d x %d pixels, and these have %d x %d", path.c_str(),
                        size.width, size.height, pair.size().width, pair.size().height));
    const auto nameOf = [](int depth) { return depth == CV_8U ? "8 bit" : depth == CV_16U ? "16 bit" : "floats"; };
    if (model.depth != CV_MAT_DEPTH(pair.type()))
        CV_Error(Error::StsUnmatchedFormats,
                 format("--findings=%s is of images of %s, and these are of %s", path.c_str(), nameOf(model.depth),
                        nameOf(CV_MAT_DEPTH(pair.type()))));
}

} // namespace

int matchTiles(const CommandLineParser& parser)
{
    checkTileOptions(parser);
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 17); // what tiles of another size do not need goes back to the system
#endif
    const WindowedPair pair(parser);
    checkFindings(parser, pair);
    const Size size = pair.size();
    const String output = parser.get<String>(parser.has("output") ? "output" : "@out");
    const Ptr<HDPTreeMatcher> matcher = createPlainMatcher(parser, size.width);
    pair.checkLimits();
    pair.setKnownDisparities(parser, Rect(0, 0, 1, 1), *matcher); // throws if types are wrong
    for (const String& path : pair.readWhole())
        std::cout << "read whole " << path << std::endl;
    const bool writesTiles = isWrittenByTiles(output);
    const double area = (double)size.width * size.height;
    const double pixels = affordedPixels(parser, area * (pair.bytesInMemory() + (writesTiles ? 0 : 4)));
    if (matcher->getNumDisparities() == 0)
        takeRange(parser, pair, pixels, *matcher);
    int layers = 0;
    const PairModel model = findModel(parser, pair, *matcher, pixels, layers);
    const Tiling tiling(size, *matcher, layers, pixels);
    if (parser.has("save-findings"))
    {
        writeFindings(parser.get<String>("save-findings"), model);
        std::cout << "written    " << parser.get<String>("save-findings") << std::endl;
    }
    hdp_tools::catchInterrupts(); // so that no part of a map is left
    const Ptr<MapTiles> map = createMap(output, size, tiling.side());
    for (int i = 0; i < tiling.count(); ++i)
    {
        if (hdp_tools::isInterrupted())
        {
            std::cerr << "interrupted: no map is written" << std::endl;
            return 130;
        }
        const Rect whole = tiling.whole(i), inside = tiling.inside(i);
        matcher->setPairModel(model.tile(whole));
        const PairPart part = pair.read(whole);
        matcher->setMasks(part.leftMask, part.rightMask);
        pair.setKnownDisparities(parser, whole, *matcher);
        const Mat disparity = computeDisparity(*matcher, part.left, part.right);
        map->write(disparity(inside - whole.tl()), inside);
    }
    map->finish();
    const Rect first = tiling.whole(tiling.count() / 2);
    std::cout << format("tiles      %d of %d x %d pixels, about %d x %d with margins\n", tiling.count(), tiling.side(),
                        tiling.side(), first.width, first.height)
              << "written    " << output << std::endl;
    return 0;
}
