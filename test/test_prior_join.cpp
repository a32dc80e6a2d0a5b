// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "synthetic_pair.hpp"
#include "../src/base/units.hpp"
#include "../src/map/prior_join.hpp"

#include <numeric>

namespace opencv_test { namespace {

using hdp::PriorPoint;

//! The join once more: of all points for each pixel, in the words of prior_join.hpp
class Model
{
public:
    Model(const std::vector<PriorPoint>& points, const Mat& guide, const oracle::CensusCost& cost, int layer,
          const Mat& winners)
        : points_(points), guide_(guide), cost_(cost), winners_(winners), unit_(8. / (1 << layer))
    {
        const int enough = (int)std::ceil(std::sqrt(6. * winners.total() / points.size()));
        farthest_ = std::max(48 >> layer, 4);
        reach_ = std::min(farthest_, std::max(enough, 2));
        const int columns = winners.cols / reach_ + 1;
        const auto squareOf = [&](size_t i) {
            const Point square = points[i].place / reach_;
            return square.y * columns + square.x;
        };
        order_.resize(points.size());
        std::iota(order_.begin(), order_.end(), 0);
        std::stable_sort(order_.begin(), order_.end(), [&](size_t a, size_t b) { return squareOf(a) < squareOf(b); });
        for (const PriorPoint& point : points)
            agrees_.push_back(areAlike(winnerAt(point.place), point.disparity, point.sigma, 0));
        for (size_t i = 0; i < points.size(); ++i)
        {
            claims_.push_back(!agrees_[i] && isSupported(points[i]));
            excess_.push_back(excessOf(points[i]));
        }
        for (size_t i = 0; i < points.size(); ++i)
        {
            isContradicted_.push_back(isOfTheScene(i) && claims_[i] && (excess_[i] > 25 * 7 || meanExcess(i) > 3.5));
            speaks_.push_back(isOfTheScene(i) && (agrees_[i] || claims_[i]));
        }
    }

    Mat join(int maxDisparity) const
    {
        Mat joined = winners_.clone();
        Mat proposed = winners_.clone(), limits(winners_.size(), CV_32F, Scalar(-1)); // bits; -1: the winner stays
        for (int y = 0; y < joined.rows; ++y)
            for (int x = 0; x < joined.cols; ++x)
                propose(Point(x, y), maxDisparity, proposed.at<ushort>(y, x), limits.at<float>(y, x));
        for (int y = 0; y < joined.rows; ++y)
            for (int x = 0; x < joined.cols; ++x)
                if (limits.at<float>(y, x) >= 0 &&
                    costAround(proposed, x, y) - costAround(winners_, x, y) <= 25 * limits.at<float>(y, x))
                    joined.at<ushort>(y, x) = proposed.at<ushort>(y, x);
        return joined;
    }

private:
    struct Voice
    {
        size_t index;
        double weight, distance;
    };

    float winnerAt(Point p) const { return winners_.at<ushort>(p) / 16.f; }
    static double distanceOf(Point a, Point b) { return std::sqrt((double)(a - b).dot(a - b)); }
    static bool areAlike(float a, float b, float sigma, double distance)
    {
        return std::abs(a - b) <= 0.7 + 2 * sigma + 0.15 * distance;
    }

    //! The eight points within reach that weigh most, of equal ones the first, square by square of the reach
    std::vector<Voice> around(Point place, const std::vector<bool>& asked) const
    {
        std::vector<Voice> voices;
        for (const size_t i : order_)
        {
            const double distance = distanceOf(points_[i].place, place);
            if (distance > reach_ || !asked[i])
                continue;
            const Vec3b own = guide_.at<Vec3b>(place), other = guide_.at<Vec3b>(points_[i].place);
            int color = 0;
            for (int c = 0; c < 3; ++c)
                color = std::max(color, std::abs(own[c] - other[c]));
            voices.push_back({ i, std::exp(-distance / unit_ - color / 30.), distance });
        }
        std::stable_sort(voices.begin(), voices.end(),
                         [](const Voice& a, const Voice& b) { return a.weight > b.weight; });
        voices.resize(std::min<size_t>(voices.size(), 8));
        return voices;
    }

    //! Of a map, over 5 x 5 pixels
    int costAround(const Mat& disparity, int x, int y) const
    {
        double sum = 0;
        for (int i = -2; i <= 2; ++i)
            for (int j = -2; j <= 2; ++j)
            {
                const int row = oracle::clamped(y + i, disparity.rows), column = oracle::clamped(x + j, disparity.cols);
                sum += cost_(row, column, hdp::wholeDisparity(disparity.at<ushort>(row, column)));
            }
        return cvRound(sum);
    }

    int excessOf(const PriorPoint& point) const
    {
        const Mat flat(winners_.size(), CV_16U, Scalar(16 * cvRound(point.disparity)));
        return costAround(flat, point.place.x, point.place.y) - costAround(winners_, point.place.x, point.place.y);
    }

    //! The points in squares of the reach, of which there are as many as lie within three times the farthest one
    std::vector<size_t> squaresAround(size_t index) const
    {
        std::vector<size_t> found;
        const Point own = points_[index].place / reach_;
        for (size_t i = 0; i < points_.size(); ++i)
        {
            const Point other = points_[i].place / reach_;
            if (std::max(std::abs(other.x - own.x), std::abs(other.y - own.y)) <= 3 * farthest_ / reach_)
                found.push_back(i);
        }
        return found;
    }

    //! Per pixel, of all claims around; none: infinite
    double meanExcess(size_t index) const
    {
        double excess = 0;
        int claims = 0;
        for (const size_t i : squaresAround(index))
        {
            excess += claims_[i] ? excess_[i] : 0;
            claims += claims_[i];
        }
        return claims == 0 ? DBL_MAX : excess / (25 * claims);
    }

    bool isOfTheScene(size_t index) const
    {
        const std::vector<size_t> all = squaresAround(index);
        const auto agreeing = std::count_if(all.begin(), all.end(), [&](size_t i) { return agrees_[i]; });
        return 5 * agreeing >= 2 * (int)all.size() || (isMostlyRight() && meanExcess(index) < 2.2);
    }

    bool isMostlyRight() const
    {
        int agreeing = 0, contradicted = 0;
        for (size_t i = 0; i < points_.size(); ++i)
        {
            agreeing += agrees_[i];
            contradicted += claims_[i] && excess_[i] > 25 * 7;
        }
        return 4 * contradicted <= agreeing;
    }

    //! By a third of the points around, which may be wrong themselves
    bool isSupported(const PriorPoint& point) const
    {
        double supporting = 0, all = 0;
        for (const Voice& voice : around(point.place, std::vector<bool>(points_.size(), true)))
            if (points_[voice.index].place != point.place)
            {
                all += voice.weight;
                if (areAlike(points_[voice.index].disparity, point.disparity, point.sigma, voice.distance))
                    supporting += voice.weight;
            }
        return supporting > 0 && 3 * supporting >= all;
    }

    void propose(Point place, int maxDisparity, ushort& proposed, float& limit) const
    {
        std::vector<Voice> voices = around(place, speaks_);
        const float winner = winnerAt(place);
        double speaksFor = 0, against = 0, confirming = 0, all = 0;
        for (const Voice& voice : voices)
        {
            const PriorPoint& point = points_[voice.index];
            const bool isOfWinner = areAlike(winner, winnerAt(point.place), point.sigma, voice.distance);
            all += voice.weight;
            if (isContradicted_[voice.index])
                confirming += isOfWinner ? voice.weight : 0;
            else if (areAlike(winner, point.disparity, point.sigma, voice.distance))
                speaksFor += voice.weight;
            else if (!agrees_[voice.index] && isOfWinner)
                against += voice.weight;
        }
        voices.erase(std::remove_if(voices.begin(), voices.end(),
                                    [&](const Voice& voice) { return isContradicted_[voice.index]; }),
                     voices.end());
        if (voices.size() < 2 || (speaksFor > 0 && speaksFor >= against) || 2 * confirming >= all)
            return;
        proposed = (ushort)std::max(0, std::min(cvRound(planeAt(place, voices) * 16), maxDisparity));
        limit = against > 0 ? 7.f : (float)(3.5 * std::min(all / 0.25, 1.));
    }

    bool areOfOneSurface(size_t a, size_t b) const
    {
        return areAlike(points_[a].disparity, points_[b].disparity, points_[a].sigma,
                        distanceOf(points_[a].place, points_[b].place));
    }

    //! Least squares of the points that are alike with the one that most, by weight, are alike with
    double planeAt(Point place, const std::vector<Voice>& voices) const
    {
        size_t centre = 0;
        double best = -1;
        for (const Voice& candidate : voices)
        {
            double weight = 0;
            for (const Voice& voice : voices)
                weight += areOfOneSurface(voice.index, candidate.index) ? voice.weight : 0;
            if (weight > best)
            {
                best = weight;
                centre = candidate.index;
            }
        }
        Mat A(0, 3, CV_64F), b(0, 1, CV_64F);
        const auto add = [&](double weight, double c, double x, double y, double value) {
            const Mat row = (Mat_<double>(1, 3) << c, x, y);
            A.push_back(Mat(std::sqrt(weight) * row));
            b.push_back(Mat(1, 1, CV_64F, Scalar(std::sqrt(weight) * value)));
        };
        add(0.1, 0, 1, 0, 0); // planes resist being tilted
        add(0.1, 0, 0, 1, 0);
        for (const Voice& voice : voices)
            if (areOfOneSurface(voice.index, centre))
            {
                const PriorPoint& point = points_[voice.index];
                add(voice.weight / best, 1, (point.place.x - place.x) / unit_, (point.place.y - place.y) / unit_,
                    point.disparity - points_[centre].disparity);
            }
        Mat solution;
        cv::solve(A, b, solution, DECOMP_SVD);
        return points_[centre].disparity + (float)solution.at<double>(0);
    }

    const std::vector<PriorPoint>& points_;
    const Mat& guide_;
    const oracle::CensusCost& cost_;
    const Mat& winners_;
    const double unit_;
    int farthest_, reach_;
    std::vector<bool> agrees_, claims_, isContradicted_, speaks_; // by point
    std::vector<int> excess_;
    std::vector<size_t> order_;
};

TEST(HDPStereo_PriorJoin, model)
{
    const Size size(90, 60);
    const int numDisparities = 24;
    int changes = 0, refused = 0;
    for (int seed = 1; seed <= 12; ++seed)
    {
        SCOPED_TRACE(seed);
        const SyntheticPair pair = makeSyntheticPair(size, numDisparities, seed);
        RNG rng(seed);
        Mat left, right;
        oracle::grey(pair.left).convertTo(left, CV_16U, 4);
        oracle::grey(pair.right).convertTo(right, CV_16U, 4);
        hdp::CensusCost cost;
        cost.prepare(left, right, numDisparities, 7);
        // Winners with errors in whole parts and in single pixels
        Mat winners;
        pair.truth.convertTo(winners, CV_16U, 16);
        winners(Rect(rng.uniform(0, 50), rng.uniform(0, 30), 30, 25)).setTo(rng.uniform(0, 300));
        for (int i = 0; i < 200; ++i)
            winners.at<ushort>(rng.uniform(0, size.height), rng.uniform(0, size.width)) = (ushort)rng.uniform(0, 369);
        const int layer = seed % 3, count = seed % 4 == 0 ? 900 : 60; // dense and sparse
        Mat known(size, CV_32F, Scalar(-1));
        for (int i = 0; i < count; ++i)
        {
            const Point place(rng.uniform(0, size.width), rng.uniform(0, size.height));
            const double wrong = rng.uniform(0, seed == 12 ? 2 : 8) == 0 ? rng.uniform(3., 9.) : rng.gaussian(0.3);
            known.at<float>(place) = (float)std::min(std::max(pair.truth.at<float>(place) + wrong, 0.), 22.9);
        }
        std::vector<PriorPoint> points;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                if (known.at<float>(y, x) >= 0)
                    points.push_back({ Point(x, y), known.at<float>(y, x), (float)rng.uniform(0., 0.6) });
        const int maxDisparity = hdp::largestDisparity(numDisparities, 0);
        const Mat expected =
            Model(points, pair.left, oracle::CensusCost(left, right, 7), layer, winners).join(maxDisparity);
        Mat joined = winners.clone();
        hdp::joinPrior(points, pair.left, cost, layer, maxDisparity, joined);
        expectIdentical(expected, joined);
        const int changed = countDifferent(winners, joined);
        changes += changed;
        refused += changed == 0;
    }
    EXPECT_GT(changes, 1000);
    EXPECT_LT(refused, 6) << "priors of another scene";
}

TEST(HDPStereo_PriorJoin, a_prior_of_another_scene_changes_nothing)
{
    const SyntheticPair pair = makeSyntheticPair(Size(90, 60), 24, 2);
    Mat left, right, winners;
    oracle::grey(pair.left).convertTo(left, CV_16U, 4);
    oracle::grey(pair.right).convertTo(right, CV_16U, 4);
    hdp::CensusCost cost;
    cost.prepare(left, right, 24, 7);
    pair.truth.convertTo(winners, CV_16U, 16);
    std::vector<PriorPoint> points;
    for (int y = 2; y < 60; y += 6)
        for (int x = 2; x < 90; x += 6)
            points.push_back({ Point(x, y), pair.truth.at<float>(y, x) > 10 ? 2.f : 20.f, 0.3f });
    const Mat before = winners.clone();
    hdp::joinPrior(points, pair.left, cost, 0, hdp::largestDisparity(24, 0), winners);
    expectIdentical(before, winners);
    hdp::joinPrior({}, pair.left, cost, 0, hdp::largestDisparity(24, 0), winners);
    expectIdentical(before, winners);
}

}} // namespace opencv_test
