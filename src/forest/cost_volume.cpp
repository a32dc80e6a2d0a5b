// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "cost_volume.hpp"

#include "../base/vectorized.hpp"
#include <numeric>

namespace cv { namespace stereo { namespace hdp {

uchar CostVolume::lowestOf(int pixel) const
{
    const uchar* const first = costs.data() + start(pixel);
    const int count = numDisparities;
    uchar lowest = UCHAR_MAX;
    HDP_VECTORIZED for (int d = 0; d < count; ++d) lowest = std::min(lowest, first[d]);
    return lowest;
}

void CostVolume::create(const Size& layerSize, int candidates, int stepsPerPixel)
{
    size = layerSize;
    numDisparities = candidates;
    steps = stepsPerPixel;
    intervals = Mat();
    if ((uint64)size.area() * stride() > SIZE_MAX / sizeof(short)) // of sums, on machines of 32 bits
        CV_Error(Error::StsNoMem, "numDisparities is too large for images of this size");
    grown(costs, total());
}

void CostVolume::fill(const TwoLayerCost& cost, const Size& layerSize, int candidates)
{
    create(layerSize, candidates, cost.steps());
    parallelForRows(size, std::vector<int>(size.width), [&](int y, std::vector<int>& pixels) {
        std::vector<uchar> ofChunk(size.width * chunk);
        std::iota(pixels.begin(), pixels.end(), y * size.width);
        for (int first = 0; first < numDisparities; first += chunk)
        {
            cost.evaluate(pixels.data(), size.width, first, chunk, ofChunk.data());
            for (int x = 0; x < size.width; ++x)
                std::copy_n(&ofChunk[x * chunk], +chunk, &costs[start(pixels[x]) + first]);
        }
    });
}

void excludeCandidates(const Mat& intervals, CostVolume& volume)
{
    volume.intervals = intervals;
    const int count = volume.numDisparities;
    parallelForRows(volume.size, [&](int y) {
        for (int x = 0; x < volume.size.width; ++x)
        {
            const DisparityInterval& own = intervals.ptr<DisparityInterval>(y)[x];
            uchar* const costs = &volume.costs[volume.start(y * volume.size.width + x)];
            std::fill(costs, costs + std::min((int)own.first, count), (uchar)UCHAR_MAX);
            std::fill(costs + std::min(own.last + 1, count), costs + count, (uchar)UCHAR_MAX);
        }
    });
}

void preferDisparity(int pixel, float disparity, int limit, CostVolume& volume)
{
    CV_DbgAssert(0 <= limit && limit <= UCHAR_MAX);
    const int d = cvRound(CostVolume::scale * volume.steps * disparity);
    uchar* costs = &volume.costs[volume.start(pixel)];
    for (int begin = 0; begin < volume.numDisparities; begin += CostVolume::chunk, costs += CostVolume::chunk)
    {
        // Of 16 bits, as vectors hold more of them; far from the chunk, all of it rises by the limit.
        const short most = (short)limit, first = (short)clamped(begin * CostVolume::scale - d, -4096, 4096);
        HDP_VECTORIZED for (short k = 0; k < CostVolume::chunk; ++k)
        {
            const short distance = (short)(first + k * CostVolume::scale);
            const short beyond = (short)(std::max(distance, (short)-distance) - CostVolume::scale);
            const short rise = std::min(std::max(beyond, (short)0), most);
            costs[k] = (uchar)std::min((short)(costs[k] + rise), (short)UCHAR_MAX);
        }
    }
}

bool isContradicted(int pixel, float disparity, const CostVolume& volume)
{
    const int nearest = clamped(cvFloor(volume.steps * disparity + 0.5f), 0, volume.numDisparities - 1);
    const int cost = volume.costs[volume.start(pixel) + nearest], most = CostVolume::contradiction;
    return cost > most && cost - volume.lowestOf(pixel) > most; // the first one fails for most pixels
}

}}} // namespace cv::stereo::hdp
