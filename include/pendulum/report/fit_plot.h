// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "pendulum/identify/identification.h"

namespace pendulum {

/// What a picture may be: SVG with text as text, PNG, or PDF.
enum class PictureFormat { kSvg, kPng, kPdf };

/// The format that a file's name ends with: .svg, .png or .pdf; std::nullopt: another end.
std::optional<PictureFormat> PictureFormatOf(std::string_view path);

/// A gnuplot script that writes a picture of fit `fit` of recording k to standard output: measured and fitted readings
/// above, residuals below, on white, with axes, units, legend and title; angles and rates in degrees. Its letters can
/// be read in print 8 cm wide. Of long recordings it shows the extremes of each of some thousand intervals. The script
/// contains the data and opens no file.
std::string FitPlot(const Identification& identification, std::size_t k, std::size_t fit, PictureFormat format);

}  // namespace pendulum
