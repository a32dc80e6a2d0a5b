// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_RAW_PAIR_HPP
#define OPENCV_HDPSTEREO_TEST_RAW_PAIR_HPP

#include "test_precomp.hpp"

namespace opencv_test {

/** What two raw cameras see: a textured plane, and a textured sphere before it. In metres, in the left camera's
coordinates. */
class RawScene
{
public:
    //! The plane is normal * X = distance; a radius of 0 is no sphere.
    RawScene(Vec3d normal, double distance, Vec3d center, double radius, double cell)
        : normal_(normal), distance_(distance), center_(center), radius_(radius), cell_(cell)
    {
    }

    //! How far along the ray its first point is
    double hit(Vec3d origin, Vec3d ray) const
    {
        double distance = (distance_ - normal_.dot(origin)) / normal_.dot(ray);
        if (!(distance > 0))
            distance = 1e9;
        const Vec3d toCenter = center_ - origin;
        const double a = ray.dot(ray), b = ray.dot(toCenter), c = toCenter.dot(toCenter) - radius_ * radius_;
        const double root = b * b - a * c;
        return radius_ > 0 && root > 0 && b > 0 ? std::min(distance, (b - std::sqrt(root)) / a) : distance;
    }

    //! The grey level of a point
    uchar level(Vec3d point) const
    {
        double sum = 0;
        for (int octave = 0; octave < 3; ++octave)
            sum += (noise(point * (1 / (cell_ * (1 << octave))), octave) - 0.5) * (octave + 2) * 30;
        return cv::saturate_cast<uchar>(128 + sum);
    }

    //! The raw image of a camera
    Mat render(const StereoCalibration& c, int camera) const
    {
        const Mat &K = camera ? c.cameraMatrix2 : c.cameraMatrix1, &D = camera ? c.distCoeffs2 : c.distCoeffs1;
        const Matx33d toLeft = camera ? Matx33d(c.R).t() : Matx33d::eye();
        const Vec3d origin = camera ? Vec3d(-(toLeft * Vec3d(c.T.ptr<double>()))) : Vec3d();
        std::vector<Point2d> pixels, rays;
        for (int y = 0; y < c.imageSize.height; ++y)
            for (int x = 0; x < c.imageSize.width; ++x)
                pixels.push_back(Point2d(x, y));
        if (c.isFisheye)
            cv::fisheye::undistortPoints(pixels, rays, K, D);
        else
            cv::undistortPoints(pixels, rays, K, D, cv::noArray(), cv::noArray(),
                                TermCriteria(TermCriteria::COUNT + TermCriteria::EPS, 100, 1e-10));
        Mat image(c.imageSize, CV_8U);
        for (size_t i = 0; i < rays.size(); ++i)
        {
            const Vec3d ray = toLeft * Vec3d(rays[i].x, rays[i].y, 1);
            image.ptr()[i] = level(origin + ray * hit(origin, ray));
        }
        return image;
    }

    //! What the rectified left camera has before it, in metres along its axis
    Mat depth(const Mat& R1, const Mat& P1, Size size) const
    {
        const Matx33d toLeft = Matx33d(R1).t(), inverse = Matx33d(Mat(P1.colRange(0, 3))).inv();
        Mat result(size, CV_32F);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const Vec3d ray = inverse * Vec3d(x, y, 1);
                result.at<float>(y, x) = (float)hit(Vec3d(), toLeft * ray); // the third coordinate of the ray is 1
            }
        return result;
    }

private:
    //! Of a point of a grid, 0 to 1
    static double random(int x, int y, int z, int seed)
    {
        unsigned hash = (unsigned)x * 73856093u ^ (unsigned)y * 19349663u ^ (unsigned)z * 83492791u ^
                        (unsigned)(seed + 1) * 2654435761u;
        hash = (hash ^ hash >> 15) * 2246822519u;
        hash = (hash ^ hash >> 13) * 3266489917u;
        return (hash ^ hash >> 16) / 4294967296.;
    }

    static double smooth(double t) { return t * t * (3 - 2 * t); }

    static double noise(Vec3d p, int seed)
    {
        const int x = cvFloor(p[0]), y = cvFloor(p[1]), z = cvFloor(p[2]);
        const double tx = smooth(p[0] - x), ty = smooth(p[1] - y), tz = smooth(p[2] - z);
        double sum = 0;
        for (int i = 0; i < 8; ++i)
            sum += random(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2), seed) * (i & 1 ? tx : 1 - tx) *
                   (i & 2 ? ty : 1 - ty) * (i & 4 ? tz : 1 - tz);
        return sum;
    }

    const Vec3d normal_;
    const double distance_;
    const Vec3d center_;
    const double radius_, cell_;
};

} // namespace opencv_test

#endif
