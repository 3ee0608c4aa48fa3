#pragma once

#include <string>

#include "report/recorded_views.h"
#include "report/table.h"

namespace planbench {

/// The report as one HTML file that needs nothing else: styles, scripts, Vega and the data are in
/// it, and it forbids itself the network. three.js only if there are views.
std::string ReportPage(const Json& data, const EmbeddedViews& views);

/// A page of the same kind that shows what RunView or ProblemView made (view_data.h) in 3D.
std::string ViewPage(const Json& view);

}  // namespace planbench
