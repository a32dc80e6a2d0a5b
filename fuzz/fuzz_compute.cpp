// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A libFuzzer target: images, parameters, strategies, models, files and what is known of a pair beforehand, made of the
// fuzzer's bytes. scripts/fuzz.sh builds it with AddressSanitizer and UndefinedBehaviorSanitizer and runs it.
//
// Besides what these find, it stops if
// - something else is thrown than a cv::Exception, or what the user's own strategy throws,
// - a disparity is out of range, or the output is of another type or size,
// - a setter or read() throws and has changed the matcher or model nevertheless,
// - a matcher gives something else than one that was never used before, or than with another number of threads.
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgproc.hpp"

#include "input.hpp"

#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

using namespace cv;
using namespace cv::stereo;

namespace {

//! What the user's strategy throws besides cv::Exception
struct OutOfTrees
{
};

int anyInt(Input& input)
{
    const int corners[] = { 0, 1, -1, 2, 7, 16, 100, 101, 2047, 2048, 4095, INT_MAX, INT_MIN };
    return input.ConsumeBool() ? pick(input, corners) : input.ConsumeIntegral<int>();
}

std::string serialized(const Algorithm& algorithm, const char* extension = ".yml")
{
    FileStorage fs(extension, FileStorage::WRITE | FileStorage::MEMORY);
    algorithm.write(fs);
    return fs.releaseAndGetString();
}

//////////////////////////////////////////////// images /////////////////////////////////////////////////

//! Fills an image by one of several rules.
void fill(Input& input, Mat& image)
{
    RNG rng(input.ConsumeIntegral<ushort>() + 1);
    switch (input.ConsumeIntegralInRange(0, 5))
    {
    case 0:
        image.setTo(Scalar::all(input.ConsumeIntegral<uchar>()));
        break;
    case 1:
        rng.fill(image, RNG::UNIFORM, 0, 256);
        break;
    case 2: // few levels: many equal edges
        rng.fill(image, RNG::UNIFORM, 0, 2 + rng.uniform(0, 6));
        break;
    case 3: // patches
    {
        Mat coarse(std::max(image.rows / 5, 1), std::max(image.cols / 5, 1), image.type());
        rng.fill(coarse, RNG::UNIFORM, 0, 256);
        resize(coarse, image, image.size(), 0, 0, INTER_NEAREST);
        break;
    }
    case 4: // stripes and checkerboards
    {
        const int periodX = rng.uniform(1, 9), periodY = rng.uniform(1, 9);
        for (int y = 0; y < image.rows; ++y)
            for (int x = 0; x < image.cols; ++x)
                std::memset(image.ptr(y, x), (x / periodX + y / periodY) % 2 ? 255 : 0, image.elemSize());
        break;
    }
    default: // the fuzzer's own
        image.setTo(Scalar::all(0));
        const std::vector<uchar> bytes = input.ConsumeBytes<uchar>(64);
        for (int y = 0; y < image.rows && !bytes.empty(); ++y)
            for (size_t i = 0; i < image.cols * image.elemSize(); ++i)
                image.ptr(y)[i] = bytes[(i + 7 * y) % bytes.size()];
    }
    if (image.depth() == CV_16U) // of any number of bits
        image *= 1 + rng.uniform(0, 257);
}

//! The same image, or a part of a larger one with this content
Mat placed(Input& input, const Mat& image)
{
    if (input.ConsumeBool())
        return image;
    const Rect part(Point(input.ConsumeIntegralInRange(0, 5), input.ConsumeIntegralInRange(0, 3)), image.size());
    Mat canvas(image.rows + 5, image.cols + 7, image.type(), Scalar::all(17));
    Mat region = canvas(part);
    image.copyTo(region);
    return region;
}

//! A pair of a number of pixels that keeps one call below a second; rarely one that does not go together.
void makePair(Input& input, int numDisparities, Mat& left, Mat& right)
{
    const int types[] = { CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 };
    const int otherTypes[] = { CV_16UC3, CV_8SC3, CV_32FC1, CV_8UC2 };
    const int most = std::max(48, std::min(8000, (1 << 18) / std::max(numDisparities, 1)));
    const bool isStrip = input.ConsumeBool();
    int width = input.ConsumeIntegralInRange(1, isStrip ? most : std::min(300, most));
    int height = input.ConsumeIntegralInRange(1, std::max(most / width, 1));
    if (input.ConsumeBool())
        std::swap(width, height);
    Mat content(height, width, pick(input, types));
    fill(input, content);
    left = placed(input, content);
    Mat other(content.size(), content.type());
    if (input.ConsumeBool())
        fill(input, other);
    else // shifted
    {
        const int shift = input.ConsumeIntegralInRange(-width, width);
        for (int x = 0; x < width; ++x)
            content.col(std::min(std::max(x + shift, 0), width - 1)).copyTo(other.col(x));
    }
    right = placed(input, other);
    switch (input.ConsumeIntegralInRange(0, 40))
    {
    case 0:
        right = Mat(height + 1, width, left.type(), Scalar::all(1));
        break;
    case 1:
        left = Mat(height, width, pick(input, otherTypes), Scalar::all(1));
        break;
    case 2:
        left.release();
        break;
    }
}

//! The next frame of a video: the same, with noise, moved, or another scene
void nextFrame(Input& input, Mat& left, Mat& right)
{
    RNG rng(input.ConsumeIntegral<uchar>() + 1);
    const int kind = input.ConsumeIntegralInRange(0, 3);
    const Matx23d move(1 + rng.uniform(-0.1, 0.1), 0, rng.uniform(-9., 9.), 0, 1 + rng.uniform(-0.1, 0.1),
                       rng.uniform(-9., 9.));
    for (Mat* image : { &left, &right })
    {
        Mat next = image->clone(), noise(image->size(), image->type());
        if (kind == 1)
        {
            rng.fill(noise, RNG::UNIFORM, 0, 9);
            add(*image, noise, next);
        }
        else if (kind == 2)
            warpAffine(*image, next, move, image->size(), INTER_LINEAR, BORDER_REPLICATE);
        else if (kind == 3)
            fill(input, next);
        *image = next;
    }
}

//////////////////////////////////////////////// strategies /////////////////////////////////////////////////

//! A user's strategy that does what the fuzzer wants, within its contract or not
class FuzzedTree : public TreeStrategy
{
public:
    explicit FuzzedTree(Input& input)
        : seed_(input.ConsumeIntegral<uchar>()), unites_(input.ConsumeBool()), links_(input.ConsumeBool()),
          order_(input.ConsumeIntegralInRange(0, 9)), rule_(input.ConsumeIntegralInRange(0, 3)),
          throwAt_(input.ConsumeBool() ? input.ConsumeIntegralInRange(0, 2000) : -1),
          throwsException_(input.ConsumeBool())
    {
    }

    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        count();
        RNG rng(seed_ + 1);
        switch (order_)
        {
        case 0:
            std::reverse(edges.begin(), edges.end());
            break;
        case 1:
            std::sort(edges.begin(), edges.end(), [&](int a, int b) {
                return weights.ptr()[a] > weights.ptr()[b] || (weights.ptr()[a] == weights.ptr()[b] && a < b);
            });
            break;
        case 2:
            for (size_t i = edges.size(); i > 1; --i)
                std::swap(edges[i - 1], edges[rng.uniform(0, (int)i)]);
            break;
        case 3:
            edges.clear();
            break;
        case 4:
            edges.push_back(rng.uniform(-5, 100000));
            break;
        case 5:
            if (!edges.empty())
            {
                const int bad = rng.uniform(0, 2) ? INT_MAX : -1;
                edges[rng.uniform(0, (int)edges.size())] = bad;
            }
            break;
        }
    }

    bool ordersByWeight() const CV_OVERRIDE { return order_ == 6; }

    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        count();
        require(a.size > 0 && b.size > 0 && weight >= 0 && weight <= 255, "mayJoin: no tree, or no weight");
        switch (rule_)
        {
        case 0:
            return false;
        case 1:
            return (a.size + b.size + weight + seed_) % 3 != 0;
        case 2:
            return weight <= a.maxWeight + seed_;
        default:
            return true;
        }
    }

    bool unitesIntervals() const CV_OVERRIDE
    {
        count();
        return unites_;
    }

    bool linksTrees() const CV_OVERRIDE
    {
        count();
        return links_;
    }

    String getDefaultName() const CV_OVERRIDE { return "fuzzed_tree"; }

    bool throws() const { return throwAt_ >= 0; }
    void restart() const { calls_ = 0; }

private:
    void count() const
    {
        if (calls_++ != throwAt_)
            return;
        if (throwsException_)
            CV_Error(Error::StsError, "no more trees");
        throw OutOfTrees();
    }

    const int seed_;
    const bool unites_, links_;
    const int order_, rule_, throwAt_;
    const bool throwsException_;
    mutable std::atomic<int> calls_{ 0 };
};

//////////////////////////////////////////////// files /////////////////////////////////////////////////

//! read() of such a file. It takes all of the file or nothing.
void readFile(Input& input, Algorithm& algorithm)
{
    const char* const extensions[] = { ".yml", ".xml", ".json" };
    const std::string before = serialized(algorithm);
    const std::string text = mutated(input, serialized(algorithm, pick(input, extensions)));
    FileStorage fs;
    try
    {
        if (!fs.open(text, FileStorage::READ | FileStorage::MEMORY))
            return;
    }
    catch (const cv::Exception&) // OpenCV's parser
    {
        return;
    }
    try
    {
        algorithm.read(input.ConsumeBool() ? fs.root() : fs.getFirstTopLevelNode());
    }
    catch (const cv::Exception&)
    {
        require(serialized(algorithm) == before, "read() failed, and changed the object");
    }
}

Ptr<DisparityPredictionModel> makeModel(Input& input)
{
    const Ptr<DisparityPredictionModel> model =
        input.ConsumeBool() ? DisparityPredictionModel::createPublished(input.ConsumeIntegralInRange<int>(
                                  DisparityPredictionModel::PUBLISHED_LARGE, DisparityPredictionModel::PUBLISHED_SMALL))
                            : DisparityPredictionModel::create();
    for (int layers = input.ConsumeIntegralInRange(0, 4); layers > 0; --layers)
    {
        std::vector<double> means, sigmas, weights;
        const int components = input.ConsumeIntegralInRange(1, 3);
        for (int k = 0; k < components; ++k)
        {
            means.push_back(anyDouble(input));
            sigmas.push_back(anyDouble(input));
            weights.push_back(input.ConsumeBool() ? 1. / components : anyDouble(input));
        }
        const std::string before = serialized(*model);
        try
        {
            model->addLayer(means, sigmas, weights);
        }
        catch (const cv::Exception&)
        {
            require(serialized(*model) == before, "addLayer() failed, and changed the model");
        }
    }
    if (input.ConsumeBool())
        readFile(input, *model);
    return model;
}

//////////////////////////////////////////////// the matcher /////////////////////////////////////////////////

template <typename Set> void change(HDPTreeMatcher& matcher, const Set& set)
{
    const std::string before = serialized(matcher);
    try
    {
        set();
    }
    catch (const cv::Exception&)
    {
        require(serialized(matcher) == before, "a setter failed, and changed the matcher");
    }
}

void setParameter(Input& input, HDPTreeMatcher& m)
{
    const auto oddUpTo = [&](int last) {
        return input.ConsumeBool() ? anyInt(input) : input.ConsumeIntegralInRange(0, last / 2) * 2 + 1;
    };
    const auto upTo = [&](int last) {
        return input.ConsumeBool() && input.ConsumeBool() ? anyInt(input) : input.ConsumeIntegralInRange(-1, last + 1);
    };
    HDPTreeMatcher::Params params = m.getParams();
    change(m, [&] {
        switch (input.ConsumeIntegralInRange(0, 40))
        {
        case 0:
            return m.setMinDisparity(input.ConsumeBool() ? anyInt(input) : input.ConsumeIntegralInRange(-200, 200));
        case 1:
        case 2:
            return m.setNumDisparities(input.ConsumeBool() ? upTo(4095) : upTo(100));
        case 3:
            return m.setBlockSize(oddUpTo(7));
        case 4:
            return m.setSpeckleWindowSize(anyInt(input));
        case 5:
            return m.setSpeckleRange(upTo(2047));
        case 6:
            return m.setDisp12MaxDiff(upTo(3));
        case 7:
            return m.setTreeStrategy(createSegmentTree(anyDouble(input)));
        case 8:
            return m.setTreeStrategy(createRandomTree(anyInt(input)));
        case 9:
            return m.setTreeStrategy(createMinimumSpanningTree());
        case 10:
        case 11:
            return m.setTreeStrategy(Ptr<TreeStrategy>(new FuzzedTree(input)));
        case 12:
            params.usePrediction = input.ConsumeBool();
            break;
        case 13:
            params.useMedianPrefilter = input.ConsumeBool();
            break;
        case 14:
            params.numLayers = input.ConsumeBool() ? upTo(16) : anyInt(input);
            break;
        case 15:
            params.delta0 = anyDouble(input);
            break;
        case 16:
            params.beta = anyDouble(input);
            break;
        case 17:
            params.gamma = anyDouble(input);
            break;
        case 18:
            params.colorTruncation = anyDouble(input);
            break;
        case 19:
            params.gradientTruncation = anyDouble(input);
            break;
        case 20:
            params.colorWeight = anyDouble(input);
            break;
        case 21:
            params.disparityMedianSize = input.ConsumeBool() ? oddUpTo(7) : upTo(5);
            break;
        case 22:
            params.matchingCost = upTo(1);
            break;
        case 23:
            params.disparityPrior = upTo(1);
            break;
        case 24:
            params.intervalMargin = upTo(64);
            break;
        case 25:
            params.useSubpixel = input.ConsumeBool();
            break;
        case 26:
            params.aggregation = upTo(2);
            break;
        case 27:
            params.P1 = upTo(100);
            break;
        case 28:
            params.finestLayer = upTo(15);
            break;
        case 29:
            params.scanlinePasses = upTo(4);
            break;
        case 30:
            return m.setDisparityDepth(input.ConsumeBool() ? CV_32F : anyInt(input));
        case 31:
            params.fillOcclusions = input.ConsumeBool();
            break;
        case 32:
            params.P2 = upTo(100);
            break;
        case 33:
            params.maxTopDisparities = upTo(100);
            break;
        case 34:
            params.topAggregation = upTo(2);
            break;
        case 35:
            return m.setMaxRowOffset(upTo(100));
        case 36:
            return m.setUseLightAlignment(input.ConsumeBool());
        case 37:
            return m.setNoiseThreshold(anyDouble(input));
        case 38:
        case 39:
            return m.setUseTemporalPrediction(input.ConsumeBool());
        default:
            params.useNonLocalRefinement = input.ConsumeBool();
        }
        m.setParams(params);
    });
}

//////////////////////////////////////////////// what is known beforehand /////////////////////////////////////////////////

//! Arguments of setters, valid or not
struct Known
{
    Mat leftMask, rightMask, smallest, largest, prior, sigma;
    PairModel model;

    bool hasInvalid() const { return !leftMask.empty() || !smallest.empty(); }
};

//! A number for a map of disparities; what is none, too
float anyDisparity(Input& input)
{
    const float special[] = { NAN, INFINITY, -INFINITY, 1e30f, -1e30f, 32767.9f, 0.5f };
    return input.ConsumeIntegralInRange(0, 5) == 0 ? pick(input, special)
                                                   : input.ConsumeIntegralInRange(-1200, 1200) / 16.f;
}

//! Few values in rectangles
Mat disparityMap(Input& input, Size size, int type, float otherwise)
{
    Mat map(size, type, Scalar(otherwise));
    for (int i = input.ConsumeIntegralInRange(0, 5); i > 0; --i)
    {
        const int x = input.ConsumeIntegralInRange(0, size.width - 1),
                  y = input.ConsumeIntegralInRange(0, size.height - 1);
        const Rect part(x, y, input.ConsumeIntegralInRange(1, size.width - x),
                        input.ConsumeIntegralInRange(1, size.height - y));
        map(part).setTo(Scalar(anyDisparity(input)));
    }
    return map;
}

Mat anyMask(Input& input, Size size)
{
    Mat mask(size, CV_8UC1);
    if (input.ConsumeBool())
        return Mat();
    fill(input, mask);
    return mask;
}

//! As that of the last pair, with one field changed
PairModel anyModel(Input& input, const PairModel& last)
{
    PairModel model = last;
    switch (input.ConsumeIntegralInRange(0, 10))
    {
    case 0:
        model.minDisparity = input.ConsumeIntegralInRange(-100, 100);
        break;
    case 1:
        model.numDisparities = input.ConsumeIntegralInRange(-1, 100);
        break;
    case 2:
        model.x = anyInt(input);
        break;
    case 3:
        model.width = anyInt(input);
        break;
    case 4:
        model.rows[input.ConsumeIntegralInRange(0, 4)] = anyDisparity(input);
        model.areRowsMoved = true;
        break;
    case 5:
        model.light[input.ConsumeIntegralInRange(0, 9)] = anyDisparity(input);
        model.isLightChanged = true;
        break;
    case 6:
        model.bits = input.ConsumeIntegralInRange(7, 17);
        break;
    case 7:
        model.brightness = input.ConsumeIntegralInRange(0, 5);
        model.isGrey = input.ConsumeBool();
        break;
    case 8:
        model.leftBlockStep = model.rightBlockStep = anyDisparity(input);
        model.leftBlockStart = input.ConsumeIntegralInRange(-1, 8);
        break;
    case 9:
        model.black = anyDisparity(input);
        model.white = anyDisparity(input);
        break;
    default:
        model.noise = anyDisparity(input);
        model.noiseLayer = input.ConsumeIntegralInRange(-1, 16);
    }
    return model;
}

Known anyKnown(Input& input, Size size, const PairModel& last)
{
    Known known;
    const auto sizeOf = [&] {
        return input.ConsumeIntegralInRange(0, 20) > 0
                   ? size
                   : Size(input.ConsumeIntegralInRange(1, 40), input.ConsumeIntegralInRange(1, 40));
    };
    if (size.empty())
        return known;
    if (input.ConsumeBool())
    {
        known.leftMask = anyMask(input, sizeOf());
        known.rightMask = anyMask(input, sizeOf());
    }
    if (input.ConsumeBool())
    {
        const Size coarse(input.ConsumeIntegralInRange(1, size.width), input.ConsumeIntegralInRange(1, size.height));
        const int type = input.ConsumeBool() ? CV_16SC1 : CV_32FC1;
        known.smallest = disparityMap(input, coarse, type, anyDisparity(input));
        known.largest = disparityMap(input, coarse, type, anyDisparity(input));
        if (input.ConsumeIntegralInRange(0, 9) > 0)
            known.largest = max(known.smallest, known.largest);
    }
    if (input.ConsumeBool())
    {
        const Size whole = sizeOf();
        known.prior = disparityMap(input, whole, CV_32FC1, input.ConsumeBool() ? NAN : anyDisparity(input));
        if (input.ConsumeBool())
            known.sigma = abs(disparityMap(input, whole, CV_32FC1, 1));
        else
            known.sigma = Mat(1, 1, CV_64F, Scalar(input.ConsumeIntegralInRange(-1, 40) / 8.));
    }
    if (!last.empty() && input.ConsumeBool())
        known.model = anyModel(input, last);
    return known;
}

//! What is refused is left out, in all matchers that get it.
void setKnown(Known& known, HDPTreeMatcher& matcher)
{
    const auto accepts = [&](const std::function<void()>& set) {
        try
        {
            set();
            return true;
        }
        catch (const cv::Exception&)
        {
            return false;
        }
    };
    if (!accepts([&] { matcher.setMasks(known.leftMask, known.rightMask); }))
        known.leftMask = known.rightMask = Mat();
    if (!accepts([&] { matcher.setDisparityRange(known.smallest, known.largest); }))
        known.smallest = known.largest = Mat();
    if (!accepts([&] { matcher.setPriorDisparity(known.prior, known.sigma); }))
        known.prior = known.sigma = Mat();
    if (!accepts([&] { matcher.setPairModel(known.model); }))
        known.model = PairModel();
    matcher.setMasks(known.leftMask, known.rightMask);
    matcher.setDisparityRange(known.smallest, known.largest);
    matcher.setPriorDisparity(known.prior, known.sigma);
    matcher.setPairModel(known.model);
}

//! compute() of this matcher; false if it refuses.
bool tryCompute(HDPTreeMatcher& matcher, const Mat& left, const Mat& right, Mat& disparity)
{
    if (const FuzzedTree* tree = dynamic_cast<const FuzzedTree*>(matcher.getTreeStrategy().get()))
        tree->restart();
    try
    {
        matcher.compute(left, right, disparity);
        return true;
    }
    catch (const cv::Exception&)
    {
    }
    catch (const OutOfTrees&)
    {
    }
    return false;
}

void checkOutput(const HDPTreeMatcher& matcher, const Known& known, Size size, const Mat& disparity)
{
    require(disparity.size() == size && disparity.type() == matcher.getDisparityDepth(),
            "compute() gave another size or type");
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const double first = findings.minDisparity, last = first + findings.numDisparities - 1;
    require(matcher.getNumDisparities() == 0 ||
                (first == matcher.getMinDisparity() && findings.numDisparities == matcher.getNumDisparities()),
            "another range than that which was set");
    const bool hasInvalid = matcher.getDisp12MaxDiff() > 0 || matcher.getSpeckleWindowSize() > 0 ||
                            known.hasInvalid() || matcher.getPairModel().borderLevel > 0;
    Mat pixels;
    disparity.convertTo(pixels, CV_64F, disparity.depth() == CV_16S ? 1. / StereoMatcher::DISP_SCALE : 1);
    for (int y = 0; y < pixels.rows; ++y)
        for (int x = 0; x < pixels.cols; ++x)
        {
            const double d = pixels.at<double>(y, x);
            require((d >= first && d <= last) || (hasInvalid && d == first - 1), "a disparity is out of range");
        }
}

//! What a matcher tells of its last pair, if there is one
void query(const HDPTreeMatcher& matcher, Size size, bool hasPair)
{
    Mat confidence, trees, intervals;
    matcher.getConfidence(confidence);
    require(confidence.size() == (hasPair ? size : Size()), "confidence of another size");
    matcher.getForest(trees, intervals);
    const bool mayHaveNone = !hasPair || matcher.getUseTemporalPrediction() ||
                             matcher.getParams().topAggregation == HDPTreeMatcher::AGGREGATION_SCANLINES;
    require(trees.size() == intervals.size() && (mayHaveNone || !trees.empty()), "no forest");
    std::vector<double> values;
    for (int layer = 0; layer < 17; ++layer)
    {
        Mat disparity;
        matcher.getLayerPrior(layer, values);
        matcher.getLayerDisparity(layer, disparity);
        require(hasPair || (values.empty() && disparity.empty()), "a layer without a pair");
    }
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    require(findings.searchRatios.empty() != hasPair && findings.stages.empty() != hasPair &&
                findings.stages.size() == findings.stageTimes.size(),
            "findings of another pair");
}

bool areEqual(const Mat& a, const Mat& b)
{
    Mat different;
    compare(a, b, different, CMP_NE);
    return countNonZero(different) == 0;
}

//! One that was never used, with the same parameters
Ptr<HDPTreeMatcher> freshCopy(const HDPTreeMatcher& matcher)
{
    const Ptr<HDPTreeMatcher> copy = HDPTreeMatcher::create();
    copy->setTreeStrategy(matcher.getTreeStrategy());
    FileStorage fs(serialized(matcher), FileStorage::READ | FileStorage::MEMORY);
    copy->read(fs.root());
    return copy;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***);
extern "C" int LLVMFuzzerInitialize(int*, char***) { return silenceErrors(); }

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    Input input(data, size);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(
        0, input.ConsumeIntegralInRange(0, 70), input.ConsumeIntegralInRange(0, (int)HDPTreeMatcher::PRESET_TREE));
    for (int round = input.ConsumeIntegralInRange(1, 3); round > 0; --round)
    {
        for (int changes = input.ConsumeIntegralInRange(0, 8); changes > 0; --changes)
            setParameter(input, *matcher);
        if (input.ConsumeIntegralInRange(0, 3) == 0)
        {
            HDPTreeMatcher::Params params = matcher->getParams();
            params.predictionModel = makeModel(input);
            matcher->setParams(params);
        }
        if (input.ConsumeIntegralInRange(0, 3) == 0)
            readFile(input, *matcher);
        setNumThreads(input.ConsumeIntegralInRange(1, 3));

        Mat left, right, disparity, again;
        makePair(input, matcher->getNumDisparities(), left, right);
        const PairModel last = matcher->getPairModel();
        Known known;
        if (input.ConsumeIntegralInRange(0, 2) == 0)
            known = anyKnown(input, left.size(), last);
        setKnown(known, *matcher);
        const bool hasPair = tryCompute(*matcher, left, right, disparity);
        query(*matcher, left.size(), hasPair);
        if (!hasPair)
            continue;
        checkOutput(*matcher, known, left.size(), disparity);
        const Ptr<DisparityPredictionModel> model = matcher->getParams().predictionModel;
        if (model && model->empty())
            continue; // it cannot be told from none in a file
        setNumThreads(input.ConsumeIntegralInRange(1, 3));
        const Ptr<HDPTreeMatcher> fresh = freshCopy(*matcher);
        setKnown(known, *fresh);
        if (matcher->getUseTemporalPrediction())
        {
            matcher->clear();
            require(tryCompute(*matcher, left, right, disparity), "a matcher refuses the pair after clear()");
        }
        require(tryCompute(*fresh, left, right, again), "a fresh matcher refuses the pair");
        require(areEqual(disparity, again), "a fresh matcher gives another map");
        const int frames = matcher->getUseTemporalPrediction() ? input.ConsumeIntegralInRange(0, 3) : 0;
        for (int frame = 0; frame < frames; ++frame)
        {
            nextFrame(input, left, right);
            setNumThreads(input.ConsumeIntegralInRange(1, 3));
            const bool isMatched = tryCompute(*matcher, left, right, disparity);
            setNumThreads(input.ConsumeIntegralInRange(1, 3));
            require(tryCompute(*fresh, left, right, again) == isMatched, "only one of two matchers refuses a frame");
            if (!isMatched)
                continue;
            checkOutput(*matcher, known, left.size(), disparity);
            require(areEqual(disparity, again), "a video's map depends on more than its frames");
        }
    }
    return 0;
}
