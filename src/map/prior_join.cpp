// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "prior_join.hpp"
#include "point_grid.hpp"

#include "../base/units.hpp"
#include "../base/vectorized.hpp"
#include "../base/window_sums.hpp"

#include <cmath>

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, minAgreement, 0.4, "share of the points around",
            "that agree with the winners where the prior is right: half of the winners of a hard scene are wrong");
HDP_TUNABLE(double, tolerance, 0.7, "pixels", "of what agrees, beside two sigmas: less takes rounding for errors");
HDP_TUNABLE(double, slope, 0.15, "pixels per pixel", "by which disparities of a surface may differ beside that");
HDP_TUNABLE(int, reach, 48, "pixels of the image", "from a pixel to the points it knows: more sees other surfaces");
HDP_TUNABLE(double, pointsOfCell, 6, "points", "in a square of the reach that are enough: more cost time");
HDP_TUNABLE(double, distanceScale, 8, "pixels of the image", "by which the weight of a point falls to 1 / e");
HDP_TUNABLE(double, flatness, 0.1, "squared distanceScale", "by which planes resist being tilted: points in a row");
HDP_TUNABLE(
    double, contradiction, 7, "bits",
    "by which the mean cost may be higher; half of that for the mean of the points around, which may have an error in "
    "common, and where no point opposes the winner: more follows errors, and loses small things");
HDP_TUNABLE(double, enoughWeight, 0.25, "weight of points",
            "around, from which half of the contradiction is allowed; in proportion below: far points know less of "
            "small things");
HDP_TUNABLE(
    double, indifference, 2.2, "bits",
    "the same where few points agree with the winners, as on bare walls, whose winners are noise: more follows errors");
HDP_TUNABLE(double, mostContradicted, 0.25, "times the points that agree",
            "of a prior that is believed on such walls: more believes that of another scene, less misses bare scenes");
HDP_TUNABLE(int, around, 3, "times the reach",
            "on each side, that points are around: in less, all of a large wrong patch are opposed to the winners");

// Pixels; side of the windows of costs that are compared: single ones are noise
const int windowSide = 5, windowArea = windowSide * windowSide;

//! What is known of a point
enum PointState
{
    AGREES,       // with the winner
    COUNTS,       // against the winner
    CLAIMS,       // it will count, or be contradicted
    CONTRADICTED, // by the costs, which speak for the winner
    FAILS         // says nothing
};

//! Joins a layer's winners with its points.
class PriorJoin
{
public:
    PriorJoin(const std::vector<PriorPoint>& points, const Mat& guide, const CensusCost& cost, int layer, Mat& winners)
        : cost_(cost), winners_(winners), farthest_(std::max(reach >> layer, 4)), unit_(distanceScale / (1 << layer)),
          grid_(points, guide, reachOf(winners.size(), points.size(), farthest_), unit_), points_(grid_.points()),
          states_(points.size(), AGREES), before_(points.size()), excess_(points.size())
    {
        for (size_t i = 0; i < points.size(); ++i)
            before_[i] = winners.at<ushort>(points_[i].place) * (1.f / subpixelScale);
        sumCosts(winners, ofWinners_);
    }

    void join(int maxDisparity)
    {
        judgePoints();
        Mat agrees(winners_.size(), CV_8U, Scalar(0)); // 1 where the point at a pixel does
        for (size_t i = 0; i < points_.size(); ++i)
            agrees.at<uchar>(points_[i].place) = states_[i] == AGREES;
        const auto isContested = [this](int i) { return states_[i] == COUNTS || states_[i] == CONTRADICTED; };
        Mat hypotheses = winners_.clone(), limits(winners_.size(), CV_32F, Scalar(0)), ofHypotheses;
        grid_.forEachCell([&](const Rect& cell, Surroundings& seen) {
            grid_.gather(
                cell, [this](int i) { return states_[i] != FAILS; }, seen);
            std::vector<int> contested;
            for (int i = 0; i < (int)seen.index.size(); ++i)
                if (isContested(seen.index[i]))
                    contested.push_back(i);
            for (int y = cell.y; y < cell.br().y; ++y)
                for (int x = cell.x; x < cell.br().x; ++x)
                    if (!contested.empty() || !agrees.at<uchar>(y, x)) // or the winner stays
                        limits.at<float>(y, x) =
                            propose(Point(x, y), maxDisparity, contested, seen, hypotheses.at<ushort>(y, x));
        });
        sumCosts(hypotheses, ofHypotheses);
        parallelForRows(winners_.size(), [&](int y) {
            for (int x = 0; x < winners_.cols; ++x)
            {
                const int more = ofHypotheses.ptr<ushort>(y)[x] - ofWinners_.ptr<ushort>(y)[x];
                if (more <= windowArea * limits.ptr<float>(y)[x])
                    winners_.ptr<ushort>(y)[x] = hypotheses.ptr<ushort>(y)[x];
            }
        });
    }

private:
    //! How far a pixel of a layer of this size sees: so far that a square of the reach has pointsOfCell points in the
    //! mean
    static int reachOf(Size size, size_t points, int farthest)
    {
        const int ofDensity = cvCeil(std::sqrt(pointsOfCell * size.area() / (double)points));
        return std::min(farthest, std::max(ofDensity, 2));
    }

    //! Whether two disparities may be of one surface. sigma: of one of them, distance: of their places; all in pixels
    bool areAlike(float a, float b, float sigma, double distance) const
    {
        return std::abs(a - b) <= tolerance + 2 * sigma + slope * distance;
    }

    //! By how much the costs around a point are higher at its disparity than at the winners
    int excessOf(int index) const
    {
        const PriorPoint& point = points_[index];
        const int radius = windowSide / 2;
        int pixels[windowArea], count = 0, sum = 0;
        for (int dy = -radius; dy <= radius; ++dy)
            for (int dx = -radius; dx <= radius; ++dx)
                pixels[count++] = clamped(point.place.y + dy, 0, winners_.rows - 1) * winners_.cols +
                                  clamped(point.place.x + dx, 0, winners_.cols - 1);
        uchar costs[4 * windowArea];
        cost_.evaluate(pixels, windowArea, cvRound(point.disparity), 4, costs);
        for (int i = 0; i < windowArea; ++i)
            sum += costs[4 * i];
        return sum - ofWinners_.ptr<ushort>(point.place.y)[point.place.x];
    }

    //! Finds the states of the points.
    void judgePoints()
    {
        for (size_t i = 0; i < points_.size(); ++i)
            if (!areAlike(before_[i], points_[i].disparity, points_[i].sigma, 0))
                states_[i] = FAILS;
        grid_.forEachCell([&](const Rect& cell, Surroundings& seen) {
            const Range own = grid_.pointsOf(grid_.cellOf(cell.tl()));
            const auto last = states_.begin() + own.end;
            if (std::find(states_.begin() + own.start, last, FAILS) == last)
                return;
            grid_.gather(
                cell, [](int) { return true; }, seen);
            for (int i = own.start; i < own.end; ++i)
                if (states_[i] == FAILS && isSupported(i, seen))
                {
                    states_[i] = CLAIMS; // no other point asks for it
                    excess_[i] = excessOf(i);
                }
        });
        judgeByThoseAround();
    }

    //! A claim counts unless the costs contradict it, or those around: what many have in common may be wrong as well,
    //! and their mean tells that better. Where few points agree, the prior is of something else, and all of them fail,
    //! but for bare surfaces of a scene that it is of. How many are around does not depend on how dense they are.
    void judgeByThoseAround()
    {
        Mat sums(grid_.size(), CV_64FC4,
                 Scalar::all(0)); // by cell: the claims' excess; claims, points that agree, and all
        for (size_t i = 0; i < points_.size(); ++i)
            sums.ptr<Vec4d>()[grid_.cellOf(points_[i].place)] +=
                Vec4d(excess_[i], states_[i] == CLAIMS, states_[i] == AGREES, 1);
        const int side = 2 * (around * farthest_ / grid_.reach()) + 1;
        boxFilter(sums, sums, -1, Size(side, side), Point(-1, -1), false, BORDER_CONSTANT);
        const bool isRight = isMostlyRight();
        for (size_t i = 0; i < points_.size(); ++i)
        {
            const Vec4d own = sums.ptr<Vec4d>()[grid_.cellOf(points_[i].place)];
            const double excess = own[0], claims = own[1], agreeing = own[2], all = own[3];
            const bool isContradictedHere = isContradicted(i) || excess > contradiction / 2 * windowArea * claims;
            const bool isUnseen = isRight && excess < indifference * windowArea * claims;
            if (agreeing < minAgreement * all && !isUnseen)
                states_[i] = FAILS;
            else if (states_[i] == CLAIMS)
                states_[i] = isContradictedHere ? CONTRADICTED : COUNTS;
        }
    }

    //! By the costs at the point alone
    bool isContradicted(size_t index) const { return excess_[index] > contradiction * windowArea; }

    //! Whether the costs contradict few claims, compared with the points that agree
    bool isMostlyRight() const
    {
        double agreeing = 0, contradicted = 0;
        for (size_t i = 0; i < points_.size(); ++i)
        {
            agreeing += states_[i] == AGREES;
            contradicted += isContradicted(i);
        }
        return contradicted <= mostContradicted * agreeing;
    }

    //! Whether a third of the points around, by weight, agrees with a point
    bool isSupported(int index, Surroundings& seen) const
    {
        grid_.weigh(points_[index].place, seen);
        grid_.find(seen);
        double supporting = 0, all = 0;
        for (const Neighbour& n : seen.found)
            if (n.index != index)
            {
                all += n.weight;
                if (areAlike(points_[n.index].disparity, points_[index].disparity, points_[index].sigma, n.distance))
                    supporting += n.weight;
            }
        return supporting > 0 && 3 * supporting >= all;
    }

    //! Whether the heaviest point speaks for a winner, and none can speak against it: then it stays, as it does for
    //! most pixels. contested: places of the points that may, in `seen`
    bool isConfirmed(float winner, const std::vector<int>& contested, const Surroundings& seen) const
    {
        if (seen.lowestKey == Surroundings::beyondReach)
            return true; // nothing is known
        const int heaviest = seen.placeOf(seen.lowestKey);
        const auto isNear = [&](int i, float disparity) {
            return areAlike(winner, disparity, points_[seen.index[i]].sigma, grid_.distanceTo(i, seen));
        };
        const int index = seen.index[heaviest];
        if (states_[index] == CONTRADICTED || !isNear(heaviest, points_[index].disparity))
            return false;
        return std::none_of(contested.begin(), contested.end(),
                            [&](int i) { return grid_.isWithinReach(i, seen) && isNear(i, before_[seen.index[i]]); });
    }

    //! The disparity that the points around a pixel propose, of which the contested ones have these places in `seen`;
    //! returns by how many bits its cost may be higher. proposed stays the winner if fewer than two points are not
    //! contradicted, if as much speaks for it as against it, or if half of the points, by weight, were contradicted
    //! in favour of winners like it.
    float propose(Point place, int maxDisparity, const std::vector<int>& contested, Surroundings& seen,
                  ushort& proposed) const
    {
        const float winner = winners_.ptr<ushort>(place.y)[place.x] * (1.f / subpixelScale);
        grid_.weigh(place, seen);
        if (isConfirmed(winner, contested, seen))
            return 0;
        grid_.find(seen);
        std::vector<Neighbour>& found = seen.found;
        double speaksFor = 0, against = 0, confirming = 0, all = 0;
        for (const Neighbour& n : found)
        {
            const PriorPoint& point = points_[n.index];
            const bool isOfWinner = areAlike(winner, before_[n.index], point.sigma, n.distance);
            all += n.weight;
            if (states_[n.index] == CONTRADICTED)
                confirming += isOfWinner ? n.weight : 0;
            else if (areAlike(winner, point.disparity, point.sigma, n.distance))
                speaksFor += n.weight;
            else if (states_[n.index] == COUNTS && isOfWinner)
                against += n.weight;
        }
        const auto isNone = [&](const Neighbour& n) { return states_[n.index] == CONTRADICTED; };
        found.erase(std::remove_if(found.begin(), found.end(), isNone), found.end());
        if (found.size() < 2 || (speaksFor > 0 && speaksFor >= against) || 2 * confirming >= all)
            return 0;
        proposed = (ushort)clamped(cvRound(planeAt(place, found) * subpixelScale), 0, maxDisparity);
        return (float)(against > 0 ? contradiction : contradiction / 2 * std::min(all / enoughWeight, 1.));
    }

    //! The disparity at a place of the plane through the largest set of points that are alike
    float planeAt(Point place, const std::vector<Neighbour>& found) const
    {
        double best = -1;
        int centre = 0;
        for (const Neighbour& candidate : found)
        {
            double weight = 0;
            for (const Neighbour& n : found)
                weight += isOnSurface(n.index, candidate.index) ? n.weight : 0;
            if (weight > best)
            {
                best = weight;
                centre = candidate.index;
            }
        }
        Matx33d normal(0, 0, 0, 0, flatness, 0, 0, 0, flatness);
        Vec3d right(0, 0, 0);
        for (const Neighbour& n : found)
            if (isOnSurface(n.index, centre))
            {
                const PriorPoint& point = points_[n.index];
                const Vec3d basis(1, (point.place.x - place.x) / unit_, (point.place.y - place.y) / unit_);
                const double weight = n.weight / best;
                normal += weight * basis * basis.t();
                right += weight * (point.disparity - points_[centre].disparity) * basis;
            }
        return points_[centre].disparity + (float)normal.solve(right, DECOMP_CHOLESKY)[0];
    }

    bool isOnSurface(int a, int b) const
    {
        const Point d = points_[a].place - points_[b].place;
        return areAlike(points_[a].disparity, points_[b].disparity, points_[a].sigma, std::sqrt((double)d.dot(d)));
    }

    //! Sums of the costs of disparities over windows
    void sumCosts(const Mat& disparity, Mat& sums) const
    {
        Mat costs;
        cost_.ofDisparities(disparity, costs);
        sumOverWindows(costs, windowSide, CV_16U, sums);
    }

    const CensusCost& cost_;
    Mat& winners_;
    Mat ofWinners_;      // their costs, see sumCosts()
    const int farthest_; // how far a pixel sees at most
    const double unit_;  // of distances, in pixels of the layer
    const PointGrid grid_;
    const std::vector<PriorPoint>& points_; // of the grid
    std::vector<PointState> states_;
    std::vector<float> before_; // winners at the points
    std::vector<int> excess_;   // of claims, see excessOf(); 0 of others
};

} // namespace

void pointsOfLayer(const Mat& disparity, const Mat& sigma, int minDisparity, int extension, int layer,
                   int numDisparities, std::vector<PriorPoint>& points)
{
    points.clear();
    const float scale = 1.f / (1 << layer);
    const int side = 1 << layer, rows = disparity.rows >> layer, columns = (disparity.cols + extension) >> layer;
    std::vector<Vec2f> known; // disparity and sigma of the image's pixels in one of the layer
    for (int y = 0; y < rows; ++y)
        for (int x = extension >> layer; x < columns; ++x)
        {
            known.clear();
            float nearest = -1;
            for (int i = y * side; i < (y + 1) * side; ++i)
                for (int j = x * side - extension; j < (x + 1) * side - extension; ++j)
                {
                    const float own = (disparity.ptr<float>(i)[j] - minDisparity) * scale;
                    if (!(own >= 0 && own <= numDisparities - 1)) // or NaN
                        continue;
                    known.push_back(Vec2f(own, sigma.ptr<float>(i)[j] * scale));
                    nearest = std::max(nearest, own);
                }
            Vec2f sum;
            int count = 0;
            for (const Vec2f& pixel : known)
                if (pixel[0] >= nearest - 1) // of the nearest surface
                {
                    sum += pixel;
                    ++count;
                }
            if (count > 0)
                points.push_back({ Point(x, y), sum[0] / count, sum[1] / count });
        }
}

void joinPrior(const std::vector<PriorPoint>& points, const Mat& guide, const CensusCost& cost, int layer,
               int maxDisparity, Mat& winners)
{
    if (!points.empty())
        PriorJoin(points, guide, cost, layer, winners).join(maxDisparity);
}

}}} // namespace cv::stereo::hdp
