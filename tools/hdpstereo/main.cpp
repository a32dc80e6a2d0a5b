// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a rectified stereo pair with cv::stereo::HDPTreeMatcher, and writes the disparities, a picture of them and a
// point cloud; or matches many pairs, and writes the disparities of each.

#include "../arguments.hpp"
#include "options.hpp"

#include <iostream>

#include "opencv2/core/utils/logger.hpp"

using namespace cv;

static const char* const keys =
    "{help h ?        |      | print this and exit }"
    "{version         |      | print the version and exit }"
    "{@left           |      | left image of a rectified pair, or of a raw one with --calibration, of 8 or 16 bit "
    "or grey floats }"
    "{@right          |      | right image }"
    "{@out            |      | disparities, as --output; with --batch a folder }"
    "{batch           |      | --batch LEFTS RIGHTS OUT: matches files of the same name in two folders, or --batch "
    "LIST OUT: "
    "a line 'LEFT RIGHT NAME' per pair (between tabs if paths have spaces); writes OUT/NAME.png, keeps what is there, "
    "leaves out bad pairs (exit status 2). OUT/hdpstereo.yml keeps the options; maps of others are not continued }"
    "{format          | png  | png, pfm or tif: what --batch writes, see --output }"
    "{preset          | fast | set of parameters: ultrafast, fast, quality, tree or paper }"
    "{min-disparity   | 0    | smallest disparity in pixels }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16; 0: found "
    "in the pair, with the smallest one }"
    "{calibration     |      | the images are raw ones of these cameras: OpenCV's intrinsics.yml, ROS's left.yaml, "
    "Kalibr's camchain.yaml, EuRoC's sensor.yaml or the ZED's SN12345.conf }"
    "{calibration2    |      | the other file of --calibration: extrinsics.yml, right.yaml, the right camera's "
    "sensor.yaml }"
    "{unit            | 1    | metres in the unit of OpenCV's extrinsics.yml }"
    "{field-of-view   | 0    | of the rectified images in degrees; 0: as much as leaves hardly an empty pixel, with "
    "fisheye as much as keeps the focal length }"
    "{findings        |      | matches as --save-findings of another pair of the rig says; nothing is estimated }"
    "{save-findings   |      | what was found in the pair, rows, light, noise and levels: FILE.yml, .xml or .json }"
    "{left-mask       |      | picture of the left image's size, black where that has no data; of all pairs of --batch "
    "}"
    "{right-mask      |      | the same as --left-mask, of the right image }"
    "{smallest        |      | disparities of the left image, or of a coarser one (not with --tiles): no pixel gets a "
    "smaller one. "
    "FILE.pfm or .tif (float, not finite = no limit) or .png (16 bit, times 256, 0 = no limit); of all pairs of "
    "--batch }"
    "{largest         |      | the same as --smallest: no pixel gets a larger one }"
    "{prior           |      | disparities of the left image that are about known, of a lidar, say; files as those of "
    "--smallest }"
    "{prior-sigma     | 0.5  | their standard deviation in pixels }"
    "{tiles           |      | matches by tiles that know their place, for images of any size: of TIFF, windows are "
    "read; OUT may be FILE.tif, which is written by tiles. --memory says how large they are }"
    "{memory          | 1024 | MiB that --tiles may take }"
    "{output          |      | disparities: FILE.png (16 bit, times 256, 0 = none, from 0 to 255 alone), FILE.tif "
    "(float, nan = none), FILE.pfm or .exr (float, inf = none) }"
    "{sigma           |      | standard deviation of each disparity's error in pixels, as --output }"
    "{confidence      |      | how reliable each disparity is, 0 to 255: FILE.png (8 bit), .tif, .pfm or .exr (float) }"
    "{reasons         |      | why each pixel has its disparity, a file as --confidence: 0 matched, 1 hidden in the "
    "right image, 2 "
    "outside of it, 3 masked, 4 and 5 rejected by a filter, 6 moved into its range }"
    "{picture         |      | disparities in colors: far is blue, near is orange, none is black }"
    "{truth           |      | true disparities: PNG, 8 bit or 16 bit (times 256), 0 = unknown }"
    "{compare         |      | also by cv::StereoSGBM: times, errors, and its picture between the left image and ours }"
    "{depth           |      | FILE.png (16 bit, millimetres, 0 = none), or FILE.pfm or .tif (float, metres, nan = none); "
    "needs --calibration }"
    "{point-cloud     |      | colored points: FILE.ply; needs --calibration, --reprojection, or --focal and "
    "--baseline }"
    "{reprojection    |      | file with the matrix Q of cv::stereoRectify, as stereo_calib.cpp of OpenCV's samples "
    "writes it: extrinsics.yml }"
    "{focal           |      | focal length in pixels; the principal point is the center of the image }"
    "{baseline        |      | distance of the cameras, in the unit of the points }";

//! Options that have no effect without another one, or do not go together
static void checkCompany(int argc, const char* const argv[], const CommandLineParser& parser)
{
    const String needed[][2] = { { "memory", "tiles" },
                                 { "format", "batch" },
                                 { "prior-sigma", "prior" },
                                 { "calibration2", "calibration" },
                                 { "unit", "calibration" },
                                 { "field-of-view", "calibration" },
                                 { "focal", "point-cloud" },
                                 { "baseline", "point-cloud" },
                                 { "reprojection", "point-cloud" } };
    for (int i = 1; i < argc; ++i)
        for (const String* names : needed)
            if (hdp_tools::optionName(argv[i]) == names[0] && !parser.has(names[1]))
                CV_Error(Error::StsBadArg, "--" + names[0] + " needs --" + names[1]);
    const String ways[] = { "calibration", "reprojection", "focal", "baseline" }; // to points, the first one counts
    for (int i = 0; i < 2; ++i)
        for (int j = i + 1; j < 4 && parser.has(ways[i]); ++j)
            if (parser.has(ways[j]))
                CV_Error(Error::StsBadArg, "--" + ways[j] + " does not go with --" + ways[i]);
    if (parser.has("prior") && parser.get<String>("preset") == "paper") // whose cost is not the census
        CV_Error(Error::StsBadArg, "--prior does not go with --preset=paper");
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    int status = 0;
    try
    {
        hdp_tools::checkArguments(argc, argv, parser, { "version", "batch", "tiles", "compare" }, 3);
        checkCompany(argc, argv, parser);
        if (parser.has("help"))
        {
            CommandLineParser defaults(1, argv, keys); // whose values are those that help shows
            defaults.about("Disparities of a rectified stereo pair, or of many.");
            defaults.printMessage();
        }
        else if (parser.has("version"))
            std::cout << "hdpstereo " << HDPSTEREO_VERSION << " (OpenCV " << CV_VERSION << ")" << std::endl;
        else if (parser.has("tiles"))
            status = matchTiles(parser);
        else if (parser.has("batch"))
            status = matchPairs(parser) == 0 ? 0 : 2;
        else
            matchPair(parser);
        if (!std::cout.flush())
            CV_Error(Error::StsError, "cannot write to the standard output");
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return status;
}
