// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "recording/readers/containers/workbook.h"
#include "recording/readers/containers/zip_members.h"

namespace pendulum {

/// The table in an array of NumPy (.npy, NEP 1), as CSV text of at most `max_bytes`: a vector, a matrix of N rows or N
/// columns, or records with names. Matrices have no header. Dates become text.
///
/// A reader of its own: Debian has no library for the format but NumPy itself, and cnpy elsewhere trusts its input.
Workbook ReadNpy(std::string_view bytes, std::size_t max_bytes);

/// True if all files are arrays of NumPy (.npz).
bool IsNpz(const ZipMembers& zip);

/// The tables in a file of several arrays (.npz). All vectors are the columns of one table; a matrix or an array of
/// records is a table with the name of its file. Single numbers and texts are lines `# key: value`.
Workbook ReadNpz(const ZipMembers& zip, std::size_t max_bytes);

}  // namespace pendulum
