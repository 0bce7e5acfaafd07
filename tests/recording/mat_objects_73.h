// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <hdf5.h>
#include <unistd.h>

#include "tests/recording/mat_objects.h"

/// Files of version 7.3 with objects, written by HDF5.
namespace pendulum::objects {

class Writer73 {
 public:
  explicit Writer73(bool is_packed) : is_packed_(is_packed) {}

  std::string File73(const File& file) {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("mat_objects_" + std::to_string(::getpid()))).string();
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, 512);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    H5Pclose(creation);
    values_ = H5Gcreate2(file_, "#refs#", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (const auto& [name, array] : file.variables()) Write(file_, name, array);
    const hid_t subsystem = H5Gcreate2(file_, "#subsystem#", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const std::vector<Array> cells = file.AllCells(false);
    WriteCells(subsystem, "MCOS", {"cell", {1, cells.size()}, {}, {}, {}, cells}, "FileWrapper__");
    H5Gclose(subsystem);
    H5Gclose(values_);
    H5Fclose(file_);
    std::ifstream stream(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(path);
    std::string header =
        "MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Mar  2 10:00:00 2026 HDF5 schema 1.00 .";
    header.resize(124, ' ');
    return bytes.replace(0, 128, header + Bytes(0x0200, 2, false) + "IM");
  }

 private:
  static void WriteNumberAttribute(hid_t object, const char* name, int number) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_INT, &number);
    H5Aclose(attribute);
    H5Sclose(space);
  }

  static void WriteClassAttribute(hid_t object, const std::string& name) {
    const hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, name.size());
    const hid_t attribute = H5Acreate2(object, "MATLAB_class", type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, name.data());
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
  }

  /// HDF5 stores sizes in the reverse of MATLAB's order.
  static hid_t Dataset(hid_t group, const std::string& name, const std::vector<std::size_t>& sizes, hid_t type,
                       hid_t memory, const void* data, bool is_packed = false) {
    const std::vector<hsize_t> lengths(sizes.rbegin(), sizes.rend());
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (is_packed) {
      H5Pset_chunk(creation, static_cast<int>(lengths.size()), lengths.data());
      H5Pset_deflate(creation, 3);
    }
    const hid_t dataset = H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Sclose(space);
    return dataset;
  }

  static hid_t TypeOf(const std::string& kind) {
    if (kind == "double") return H5T_IEEE_F64LE;
    return kind == "uint8" ? H5T_STD_U8LE : H5T_STD_U32LE;
  }

  void WriteCells(hid_t group, const std::string& name, const Array& cells, const std::string& class_name) {
    std::vector<hobj_ref_t> references;
    for (const Array& cell : cells.parts) {
      const std::string own = "v" + std::to_string(++count_);
      Write(values_, own, cell);
      H5Rcreate(&references.emplace_back(), values_, own.c_str(), H5R_OBJECT, -1);
    }
    const hid_t dataset = Dataset(group, name, cells.sizes, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, references.data());
    WriteClassAttribute(dataset, class_name);
    H5Dclose(dataset);
  }

  static void WriteFieldNames(hid_t object, const std::vector<std::string>& names) {
    std::vector<hvl_t> fields;
    for (const std::string& name : names) fields.push_back({name.size(), const_cast<char*>(name.data())});
    const hsize_t size = fields.size();
    const hid_t letter = H5Tcopy(H5T_C_S1), type = H5Tvlen_create(letter), space = H5Screate_simple(1, &size, nullptr);
    const hid_t attribute = H5Acreate2(object, "MATLAB_fields", type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, fields.data());
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    H5Tclose(letter);
  }

  void WriteStructure(hid_t group, const std::string& name, const Array& structure) {
    const hid_t own = H5Gcreate2(group, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    WriteClassAttribute(own, "struct");
    if (!structure.names.empty()) WriteFieldNames(own, structure.names);
    for (std::size_t i = 0; i < structure.parts.size(); ++i) Write(own, structure.names[i], structure.parts[i]);
    H5Gclose(own);
  }

  void Write(hid_t group, const std::string& name, const Array& array) {
    const bool is_empty = std::find(array.sizes.begin(), array.sizes.end(), std::size_t{0}) != array.sizes.end();
    if (array.kind == "struct") return WriteStructure(group, name, array);
    if (array.kind == "cell" && !is_empty) return WriteCells(group, name, array, "cell");
    hid_t dataset = -1;
    if (is_empty) {
      const std::vector<std::uint64_t> sizes(array.sizes.begin(), array.sizes.end());
      dataset = Dataset(group, name, {sizes.size()}, H5T_STD_U64LE, H5T_NATIVE_UINT64, sizes.data());
      WriteNumberAttribute(dataset, "MATLAB_empty", 1);
    } else if (array.kind == "char") {
      const std::vector<std::uint16_t> letters(array.text.begin(), array.text.end());
      dataset = Dataset(group, name, array.sizes, H5T_STD_U16LE, H5T_NATIVE_UINT16, letters.data());
    } else {
      dataset = Dataset(group, name, array.sizes, TypeOf(array.kind), H5T_NATIVE_DOUBLE, array.numbers.data(),
                        is_packed_ && array.numbers.size() > 6);  // MATLAB compresses larger arrays
    }
    if (array.kind == "object") WriteNumberAttribute(dataset, "MATLAB_object_decode", 3);
    WriteClassAttribute(dataset, array.kind == "object" ? array.text : array.kind);
    H5Dclose(dataset);
  }

  bool is_packed_;
  hid_t file_ = -1, values_ = -1;
  std::size_t count_ = 0;
};

inline std::string Version73(const File& file, bool is_packed = false) { return Writer73(is_packed).File73(file); }

}  // namespace pendulum::objects
