#pragma once

#include <string>

#include "report/table.h"

namespace planbench {

/// The report as one HTML file that needs nothing else: styles, scripts, Vega and the data are in
/// it, and it forbids itself the network.
std::string ReportPage(const Json& data);

}  // namespace planbench
