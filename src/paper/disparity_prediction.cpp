// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "disparity_prediction.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

//! PixelIntv of a row of P(D_l | D_{l+1}), up to a factor: an interval, grown to both sides in turns as in the authors'
//! program. In the paper it is a set.
DisparityInterval growInterval(const std::vector<double>& row, double delta, int margin)
{
    const int mode = (int)(std::max_element(row.begin(), row.end()) - row.begin());
    if (!(row[mode] > 0))
        return { 1, 0 };
    int first = mode, last = mode;
    double selected = row[mode]; // c of the criterion
    for (bool grown = true; grown;)
    {
        grown = false;
        if (first > 0 && row[first - 1] > delta * (selected + row[first - 1]))
        {
            selected += row[--first];
            grown = true;
        }
        if (last + 1 < (int)row.size() && row[last + 1] > delta * (selected + row[last + 1]))
        {
            selected += row[++last];
            grown = true;
        }
    }
    return { (ushort)std::max(first - margin, 0), (ushort)std::min(last + margin, (int)row.size() - 1) };
}

} // namespace

void predictIntervals(const DisparityPredictionModel& model, int layer, const std::vector<double>& prior,
                      int upperDisparities, double delta, int margin, std::vector<DisparityInterval>& intervals)
{
    const int disparities = (int)prior.size();
    // P(D_{l+1} = i | D_l = j) depends on i - floor(j / 2) alone.
    const int lowestOffset = -((disparities - 1) / 2);
    std::vector<double> gmm(upperDisparities - lowestOffset);
    for (size_t k = 0; k < gmm.size(); ++k)
        gmm[k] = model.density(layer, lowestOffset + (int)k);

    intervals.resize(upperDisparities);
    parallelFor(upperDisparities, std::vector<double>(disparities), [&](int i, std::vector<double>& row) {
        for (int j = 0; j < disparities; ++j)
            row[j] = gmm[i - j / 2 - lowestOffset] * prior[j];
        intervals[i] = growInterval(row, delta, margin);
    });
}

void upperHistogram(const Mat& upper, int numDisparities, std::vector<double>& histogram)
{
    std::vector<double> pixels(numDisparities / 2 + 1); // of the layer above
    for (const ushort disparity : Mat_<ushort>(upper))
        ++pixels[wholeDisparity(disparity)];
    histogram.resize(numDisparities);
    for (int d = 0; d < numDisparities; ++d)
        histogram[d] = pixels[d / 2] + (double)upper.total() / pixels.size();
}

void assignIntervals(const Mat& upper, Size size, const std::vector<DisparityInterval>& intervals, Mat& pixelIntv)
{
    pixelIntv.create(size, CV_16UC2);
    parallelForRows(size, [&](int y) {
        const ushort* above = upper.ptr<ushort>(std::min(y / 2, upper.rows - 1));
        DisparityInterval* interval = pixelIntv.ptr<DisparityInterval>(y);
        for (int x = 0; x < size.width; ++x)
            interval[x] = intervals[wholeDisparity(above[std::min(x / 2, upper.cols - 1)])];
    });
}

}}} // namespace cv::stereo::hdp
