// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "stability.hpp"

#include <algorithm>
#include <cmath>

#include "opencv2/imgproc.hpp"

using namespace cv;

namespace hdp_tools {

static const double stableMove = 1;      // of a disparity, in pixels
static const double edgeStep = 2;        // of the truth, in pixels
static const int edgeRadius = 4;         // around a step, in pixels
static const double bareLevels = 2;      // mean difference of neighbours
static const int bareSize = 9;           // of the square of that mean
static const double blobShare = 0.002;   // of the image
static const double bistableRatio = 1.5; // of errors, and
static const double bistablePoints = 1;

ConfidenceCounts::ConfidenceCounts() : pixels(), unstable() {}

void ConfidenceCounts::add(const ConfidenceCounts& other)
{
    for (int level = 0; level < 256; ++level)
    {
        pixels[level] += other.pixels[level];
        unstable[level] += other.unstable[level];
    }
}

double ConfidenceCounts::unstableShare(double part) const
{
    double wanted = 0, count = 0, unstableCount = 0;
    for (const double ofLevel : pixels)
        wanted += part * ofLevel;
    for (int level = 255; level >= 0 && count < wanted; --level)
    {
        const double taken = std::min(pixels[level], wanted - count);
        if (taken <= 0)
            continue;
        count += taken;
        unstableCount += unstable[level] * taken / pixels[level];
    }
    return count > 0 ? 100 * unstableCount / count : NO_SCORE;
}

double ConfidenceCounts::correlation() const
{
    double n = 0, c = 0, c2 = 0, u = 0, cu = 0; // sums
    for (int level = 0; level < 256; ++level)
    {
        n += pixels[level];
        c += level * pixels[level];
        c2 += level * level * pixels[level];
        u += unstable[level];
        cu += level * unstable[level];
    }
    const double variances = (n * c2 - c * c) * (n * u - u * u);
    return variances > 0 ? (n * cu - c * u) / std::sqrt(variances) : NO_SCORE;
}

int Stability::worstChange() const
{
    int worst = -1;
    for (size_t i = 0; i < errors.size(); ++i)
        if (!std::isnan(errors[i]) && (worst < 0 || errors[i] > errors[worst]))
            worst = (int)i;
    return worst;
}

int Stability::bistableChange() const
{
    int found = -1;
    double largest = bistableRatio;
    for (size_t i = 0; i < errors.size(); ++i)
    {
        const double low = std::min(errors[i], cleanErrors[i]), high = std::max(errors[i], cleanErrors[i]);
        if (high - low > bistablePoints && high > largest * low)
        {
            found = (int)i;
            largest = low > 0 ? high / low : DBL_MAX;
        }
    }
    return found;
}

//! Those of the pixels that no nearer one of them hides from the right image
static Mat notHidden(const Mat& disparity, const Mat& pixels)
{
    const Mat nearest = warpToRight(disparity, pixels);
    Mat visible = Mat::zeros(disparity.size(), CV_8U);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const float d = disparity.at<float>(y, x);
            const int column = pixels.at<uchar>(y, x) && d < NO_DISPARITY ? x - cvRound(d) : -1;
            if (column >= 0 && column < disparity.cols && nearest.at<float>(y, column) <= d + 1)
                visible.at<uchar>(y, x) = 255;
        }
    return visible;
}

Mat visiblePixels(const Pair& pair, const Mat& clean)
{
    if (pair.protocol == Pair::NO_TRUTH)
        return notHidden(clean, knownPixels(clean));
    if (!pair.judgedNonOccluded.empty())
        return pair.judgedNonOccluded;
    return pair.protocol == Pair::KITTI ? notHidden(pair.truth, pair.judged) : pair.judged;
}

//! Steps between known pixels that follow each other in a row
static void markSteps(const Mat& truth, Mat& steps)
{
    for (int y = 0; y < truth.rows; ++y)
        for (int x = 0, last = -1; x < truth.cols; ++x)
        {
            if (!(truth.at<float>(y, x) < NO_DISPARITY))
                continue;
            if (last >= 0 &&
                std::abs(truth.at<float>(y, x) - truth.at<float>(y, last)) > std::max<double>(edgeStep, x - last))
                steps.row(y).colRange(last, x + 1).setTo(255);
            last = x;
        }
}

Mat edgePixels(const Mat& truth)
{
    Mat steps = Mat::zeros(truth.size(), CV_8U), columns = Mat::zeros(truth.cols, truth.rows, CV_8U), transposed, edges;
    markSteps(truth, steps);
    transpose(truth, transposed);
    markSteps(transposed, columns);
    transpose(columns, transposed);
    const int size = 2 * edgeRadius + 1;
    dilate(steps | transposed, edges, Mat::ones(size, size, CV_8U));
    return edges;
}

Mat barePixels(const Mat& image)
{
    Mat grey, change, mean;
    cvtColor(image, grey, COLOR_BGR2GRAY);
    absdiff(grey.colRange(1, grey.cols), grey.colRange(0, grey.cols - 1), change);
    copyMakeBorder(change, change, 0, 0, 0, 1, BORDER_REPLICATE);
    boxFilter(change, mean, CV_32F, Size(bareSize, bareSize));
    return mean <= bareLevels;
}

//! The disparities of the right image's pixels that a map of the left one comes to
static Mat seenFromLeft(const Mat& left, const Mat& right)
{
    Mat seen(left.size(), CV_32F, Scalar(NO_DISPARITY));
    for (int y = 0; y < left.rows; ++y)
        for (int x = 0; x < left.cols; ++x)
        {
            const float d = left.at<float>(y, x);
            const int column = d < NO_DISPARITY ? x - cvRound(d) : -1;
            if (column >= 0 && column < right.cols)
                seen.at<float>(y, x) = right.at<float>(y, column);
        }
    return seen;
}

Mat unstablePixels(const HarmlessChange& change, const Mat& clean, const Mat& restored)
{
    Mat difference; // infinite if one of them has no disparity, not a number if neither has
    absdiff(clean, change.isMirrored ? seenFromLeft(clean, restored) : restored, difference);
    return (difference > stableMove) & (difference < NO_DISPARITY);
}

Mat largeBlobs(const Mat& mask, double share)
{
    Mat labels, statistics, centroids, large = Mat::zeros(mask.size(), CV_8U);
    const int count = connectedComponentsWithStats(mask, labels, statistics, centroids);
    std::vector<uchar> isLarge(count);
    for (int i = 1; i < count; ++i)
        isLarge[i] = statistics.at<int>(i, CC_STAT_AREA) > share * (double)mask.total();
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            large.at<uchar>(y, x) = isLarge[labels.at<int>(y, x)] ? 255 : 0;
    return large;
}

namespace {

//! The pair as it is: what changes are compared with
struct CleanResult
{
    Mat disparity, confidence; // the latter is empty if the method has none
    Mat visible, occluded, edges, bare;
};

CleanResult matchClean(const Method& method, const Pair& pair)
{
    CleanResult clean;
    const Ptr<StereoMatcher> matcher = method.create(pair.disparities);
    clean.disparity = matchDensely(method, *matcher, pair.left, pair.right);
    const Ptr<HDPTreeMatcher> hdp = matcher.dynamicCast<HDPTreeMatcher>();
    if (hdp)
        hdp->getConfidence(clean.confidence);
    clean.visible = visiblePixels(pair, clean.disparity);
    const bool hasTruth = pair.protocol != Pair::NO_TRUTH;
    const Mat none = Mat::zeros(clean.visible.size(), CV_8U);
    clean.occluded = hasTruth ? Mat(knownPixels(pair.truth) & ~clean.visible) : none;
    clean.edges = hasTruth ? edgePixels(pair.truth) : none;
    clean.bare = barePixels(pair.left) & ~clean.edges;
    return clean;
}

void countConfidence(const Mat& confidence, const Mat& pixels, const Mat& unstable, ConfidenceCounts& counts)
{
    for (int y = 0; y < pixels.rows; ++y)
        for (int x = 0; x < pixels.cols; ++x)
            if (pixels.at<uchar>(y, x))
            {
                const uchar level = confidence.at<uchar>(y, x);
                counts.pixels[level]++;
                counts.unstable[level] += unstable.at<uchar>(y, x) != 0;
            }
}

//! Of each change, as those of Stability that are means over them
struct Shares
{
    std::vector<double> bare, edge, inBlobs, occluded;
};

//! Adds what a change does, without its errors.
void addMoves(const HarmlessChange& change, const CleanResult& clean, const Mat& restored, Stability& stability,
              Shares& shares)
{
    const Mat kept = keptPixels(change, clean.disparity);
    const Mat unstable = unstablePixels(change, clean.disparity, restored) & kept;
    const Mat visible = clean.visible & kept, occluded = clean.occluded & kept, moved = unstable & visible;
    stability.unstable.push_back(percent(moved, visible));
    shares.bare.push_back(percent(moved & clean.bare, visible));
    shares.edge.push_back(percent(moved & clean.edges, visible));
    shares.inBlobs.push_back(percent(moved & largeBlobs(unstable, blobShare), visible));
    shares.occluded.push_back(percent(unstable & occluded, occluded));
    if (!clean.confidence.empty())
        countConfidence(clean.confidence, visible, moved, stability.confidence);
}

} // namespace

Stability measureStability(const Method& method, const Pair& given, const std::vector<HarmlessChange>& changes,
                           const String& scene)
{
    Pair pair = given;
    toColors(pair.left, pair.right);
    const CleanResult clean = matchClean(method, pair);
    const Score cleanScore = scoreMap(clean.disparity, pair);
    Stability stability;
    stability.cleanError = mainScore(cleanScore, pair.protocol);
    Shares shares;
    for (const HarmlessChange& change : changes)
    {
        const Pair changed = changePair(change, pair, scene), judging = truthOfChanged(change, pair);
        const Ptr<StereoMatcher> matcher = method.create(changed.disparities);
        const Mat map = matchDensely(method, *matcher, changed.left, changed.right);
        const Mat restored = restoreMap(change, map, pair.left.size());
        const Score onSame = change.isMirrored ? cleanScore : scoreMap(clean.disparity, judging);
        stability.errors.push_back(mainScore(scoreMap(restored, judging), pair.protocol));
        stability.cleanErrors.push_back(mainScore(onSame, pair.protocol));
        addMoves(change, clean, restored, stability, shares);
    }
    const bool hasTruth = pair.protocol != Pair::NO_TRUTH;
    stability.bare = meanOf(shares.bare);
    stability.inBlobs = meanOf(shares.inBlobs);
    stability.edge = hasTruth ? meanOf(shares.edge) : NO_SCORE;
    stability.occluded = meanOf(shares.occluded);
    return stability;
}

} // namespace hdp_tools
