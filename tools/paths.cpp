// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "paths.hpp"

#include "opencv2/core/utils/filesystem.hpp"

namespace fs = cv::utils::fs;
using cv::String;

namespace hdp_tools {

String fileName(const String& path) { return path.substr(path.find_last_of("/\\") + 1); }

String placeOf(const String& path)
{
    if (fs::exists(path))
        return fs::canonical(path);
    const String folder = fs::getParent(path);
    return fs::join(fs::canonical(folder.empty() ? "." : folder), fileName(path));
}

} // namespace hdp_tools
