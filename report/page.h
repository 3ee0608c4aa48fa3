#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "report/recorded_views.h"
#include "report/table.h"

namespace planbench {

/// The report as one HTML file that needs nothing else: styles, scripts, Vega and the data are in
/// it, and it forbids itself the network. three.js only if there are views.
std::string ReportPage(const Json& data, const EmbeddedViews& views);

/// A page that is to be sent by mail has no more bytes.
inline constexpr std::size_t kMostPageBytes = 30'000'000;
/// Bytes that views may take beside all else of a ReportPage; 0 if that has kMostPageBytes or more.
std::size_t RoomForViews(const Json& data);

/// A page that shows 3D views: `html` with styles, three.js and the viewer (report/web/viewer.js),
/// data elements before these and a script of its own after them.
std::string PageWithViews(std::string_view html, const std::string& data, std::string_view script);

/// A page of the same kind that shows what RunView or ProblemView made (view_data.h) in 3D.
std::string ViewPage(const Json& view);

}  // namespace planbench
