// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The tables of an evaluation: those of the paper, and their like for the other datasets.

#ifndef OPENCV_HDPSTEREO_TOOLS_RESULT_TABLES_HPP
#define OPENCV_HDPSTEREO_TOOLS_RESULT_TABLES_HPP

#include "evaluation.hpp"
#include "report.hpp"
#include "tables.hpp"

namespace hdp_tools {

//! The tables that are printed. Those without a row are left out.
std::vector<Table> makeTables(const std::vector<Method>& methods, const std::vector<SceneResult>& results, int jobs);

//! All there is, for other programs
Table everyPairTable(const std::vector<Method>& methods, const std::vector<SceneResult>& results);

//! The page of the report, with these tables and the figures of the results
String reportPage(const std::vector<Table>& tables, const std::vector<Method>& methods,
                  const std::vector<SceneResult>& results, const String& summary);

} // namespace hdp_tools

#endif
