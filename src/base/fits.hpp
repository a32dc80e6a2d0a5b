// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_FITS_HPP
#define OPENCV_HDPSTEREO_FITS_HPP

#include "opencv2/core.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cv { namespace stereo { namespace hdp {

//! Where a parabola through three successive values has its minimum: from the middle one, in steps, at most half of
//! one; 0 if it has none. Real: float or double, in which it is computed.
template <typename Real> Real parabolaOffset(Real before, Real middle, Real after)
{
    const Real curvature = (before - middle) + (after - middle), half = Real(0.5);
    return curvature > 0 ? std::max(-half, std::min(half, (before - after) / curvature / 2)) : 0;
}

// Steps. The weights hardly change after these.
const int fitIterations = 6;

// Standard deviations. The residual at which the weight of a sample is a half: wrong samples pull more at a larger one;
// at a smaller one, right samples are lost.
const double outlierResidual = 2;

// Standard deviations of a normal distribution in its median absolute deviation
const double deviationOfMedian = 1.4826;

//! What a linear model of some terms is fitted to: value = coefficients . basis
template <int terms> struct FitSample
{
    Vec<double, terms> basis;
    double value;
    double deviation; // expected of the value

    double distanceFrom(const Vec<double, terms>& coefficients) const
    {
        return std::abs(value - coefficients.dot(basis));
    }
};

//! What is expected before any sample is seen
template <int terms> struct FitPrior
{
    Vec<double, terms> coefficients, deviations;
};

template <int terms> struct RobustFit
{
    Vec<double, terms> coefficients;
    Matx<double, terms, terms> covariance; // of the coefficients
};

inline double medianOf(std::vector<double> values)
{
    const size_t middle = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + middle, values.end());
    return values[middle];
}

//! Of what value() has for each of them
template <typename T, typename Value> double medianOf(const std::vector<T>& all, const Value& value)
{
    std::vector<double> values(all.size());
    std::transform(all.begin(), all.end(), values.begin(), value);
    return medianOf(values);
}

//! Distances of the samples from a model, in units of their deviations
template <int terms>
std::vector<double> fitResiduals(const std::vector<FitSample<terms>>& samples, const Vec<double, terms>& coefficients)
{
    std::vector<double> residuals;
    residuals.reserve(samples.size());
    for (const FitSample<terms>& sample : samples)
        residuals.push_back(sample.distanceFrom(coefficients) / sample.deviation);
    return residuals;
}

//! Least squares, reweighted for Cauchy's distribution of the residuals, from a start on. There has to be a sample.
template <int terms>
RobustFit<terms> fitRobustly(const std::vector<FitSample<terms>>& samples, const FitPrior<terms>& prior,
                             const Vec<double, terms>& start)
{
    RobustFit<terms> fit;
    fit.coefficients = start;
    for (int iteration = 0; iteration < fitIterations; ++iteration)
    {
        const std::vector<double> residuals = fitResiduals(samples, fit.coefficients);
        const double scale = std::max(deviationOfMedian * medianOf(residuals), 1.); // no less than expected
        Matx<double, terms, terms> information;
        Vec<double, terms> sum;
        for (int i = 0; i < terms; ++i)
        {
            information(i, i) = 1 / (prior.deviations[i] * prior.deviations[i]);
            sum[i] = prior.coefficients[i] * information(i, i);
        }
        for (size_t s = 0; s < samples.size(); ++s)
        {
            const FitSample<terms>& sample = samples[s];
            const double relative = residuals[s] / (scale * outlierResidual), deviation = scale * sample.deviation;
            const double weight = 1 / ((1 + relative * relative) * deviation * deviation);
            const Vec<double, terms> weighted = weight * sample.basis;
            sum += sample.value * weighted;
            information += weighted * sample.basis.t();
        }
        completeSymm(information, true);
        fit.covariance = information.inv(DECOMP_CHOLESKY);
        fit.coefficients = fit.covariance * sum;
    }
    return fit;
}

}}} // namespace cv::stereo::hdp

#endif
