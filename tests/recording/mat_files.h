// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <matio.h>
#include <unistd.h>

/// MAT-files for tests, written by matio.
namespace pendulum {

using MatVariables = std::vector<matvar_t*>;

/// A matrix of doubles in MATLAB's column-major order.
inline matvar_t* Matrix(const char* name, std::size_t rows, const std::vector<double>& values, int options = 0) {
  std::size_t sizes[] = {rows, rows == 0 ? 0 : values.size() / rows};
  return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes, const_cast<double*>(values.data()), options);
}

template <typename T>
matvar_t* Vector(const char* name, matio_classes kind, matio_types type, const std::vector<T>& values) {
  std::size_t sizes[] = {values.size(), 1};
  return Mat_VarCreate(name, kind, type, 2, sizes, const_cast<T*>(values.data()), 0);
}

inline matvar_t* Text(const char* name, const std::string& text) {
  std::size_t sizes[] = {1, text.size()};
  return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, sizes, const_cast<char*>(text.data()), 0);
}

inline matvar_t* Structure(const char* name, const std::vector<std::pair<const char*, matvar_t*>>& fields) {
  std::vector<const char*> names;
  for (const auto& field : fields) names.push_back(field.first);
  std::size_t sizes[] = {1, 1};
  matvar_t* structure = Mat_VarCreateStruct(name, 2, sizes, names.data(), static_cast<unsigned>(names.size()));
  for (const auto& field : fields) Mat_VarSetStructFieldByName(structure, field.first, 0, field.second);
  return structure;
}

/// The bytes of a file with these variables, which are freed.
inline std::string MatOf(const MatVariables& variables, mat_ft version = MAT_FT_MAT5, bool is_packed = true) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("mat_files_" + std::to_string(::getpid()))).string();
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, version);
  for (matvar_t* variable : variables) {
    Mat_VarWrite(file, variable, is_packed ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }
  Mat_Close(file);
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::filesystem::remove(path);
  return bytes;
}

}  // namespace pendulum
