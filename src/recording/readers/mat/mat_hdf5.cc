// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_hdf5.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace pendulum {
namespace {

using Kind = MatValue::Kind;

/// An open object of HDF5.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle(Handle&&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }

  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Turns off HDF5's error messages. matio would record them, but errors here do not affect the file's other variables.
class MutedErrors {
 public:
  MutedErrors() {
    H5Eget_auto2(H5E_DEFAULT, &handler_, &listener_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  MutedErrors(const MutedErrors&) = delete;
  MutedErrors(MutedErrors&&) = delete;
  MutedErrors& operator=(const MutedErrors&) = delete;
  MutedErrors& operator=(MutedErrors&&) = delete;
  ~MutedErrors() { H5Eset_auto2(H5E_DEFAULT, handler_, listener_); }

 private:
  H5E_auto2_t handler_ = nullptr;
  void* listener_ = nullptr;
};

/// The text in an attribute; empty if there is none.
std::string TextIn(hid_t object, const char* name) {
  constexpr std::size_t kMaxTextBytes = 256;
  if (H5Aexists(object, name) <= 0) return "";
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!attribute || !type || !space || H5Tget_class(type.id()) != H5T_STRING) return "";
  const std::size_t size = H5Tget_size(type.id());
  if (H5Tis_variable_str(type.id()) != 0 || size == 0 || size > kMaxTextBytes) return "";
  if (H5Sget_simple_extent_npoints(space.id()) != 1) return "";
  std::string text(size, '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

/// The whole number in an attribute; 0 if there is none.
int NumberIn(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return 0;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!attribute || !type || !space || H5Tget_class(type.id()) != H5T_INTEGER) return 0;
  int number = 0;
  if (H5Sget_simple_extent_npoints(space.id()) != 1) return 0;
  return H5Aread(attribute.id(), H5T_NATIVE_INT, &number) < 0 ? 0 : number;
}

/// The number of chunks of a complete dataset; 0 if it has no chunks.
hsize_t ChunksOf(hid_t dataset) {
  constexpr int kMaxSizes = H5S_MAX_RANK;
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::array<hsize_t, kMaxSizes> chunk{}, sizes{};
  const int rank = H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED || rank < 1) return 0;
  if (H5Pget_chunk(creation.id(), kMaxSizes, chunk.data()) != rank) return 0;
  hsize_t chunks = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rank); ++i) {
    const hsize_t along = chunk[i] == 0 ? 0 : sizes[i] / chunk[i] + (sizes[i] % chunk[i] != 0 ? 1 : 0);
    if (__builtin_mul_overflow(chunks, along, &chunks)) return std::numeric_limits<hsize_t>::max();
  }
  return chunks;
}

/// Whether all data were written. HDF5 would return zeros for missing data.
bool IsWritten(hid_t dataset) {
  hsize_t written = 0;
  if (const hsize_t chunks = ChunksOf(dataset); chunks > 0) {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    return H5Dget_num_chunks(dataset, space.id(), &written) >= 0 && written == chunks;
  }
  H5D_space_status_t status = H5D_SPACE_STATUS_ERROR;
  return H5Dget_space_status(dataset, &status) >= 0 && status == H5D_SPACE_STATUS_ALLOCATED;
}

/// A dataset. HDF5 stores its sizes in the reverse of MATLAB's order.
struct Dataset {
  explicit Dataset(hid_t dataset) : id(dataset) {
    constexpr int kMaxSizes = 32;
    const Handle type(H5Dget_type(id), H5Tclose);
    const Handle space(H5Dget_space(id), H5Sclose);
    if (!type || !space) return;
    kind = H5Tget_class(type.id());
    const int rank = H5Sget_simple_extent_ndims(space.id());
    std::vector<hsize_t> lengths(std::clamp(rank, 0, kMaxSizes));
    if (rank <= 0 || rank > kMaxSizes || H5Sget_simple_extent_dims(space.id(), lengths.data(), nullptr) != rank) return;
    sizes.assign(lengths.rbegin(), lengths.rend());
    if (sizes.size() == 1) sizes.push_back(1);
    count = CountIn(sizes).value_or(0);
  }

  /// All values; empty if there are none or they cannot be read.
  template <typename T>
  std::vector<T> Read(hid_t type) const {
    if (count == 0 || !IsWritten(id)) return {};
    std::vector<T> values(count);
    if (H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return {};
    return values;
  }

  bool HasNumbers() const { return kind == H5T_INTEGER || kind == H5T_FLOAT; }

  /// Whether the numbers in the file have exactly this type. HDF5 would convert numbers of another type silently.
  bool HasType(hid_t type) const {
    const Handle own(H5Dget_type(id), H5Tclose);
    return own && H5Tequal(own.id(), type) > 0;
  }

  hid_t id;
  H5T_class_t kind = H5T_NO_CLASS;
  std::vector<std::size_t> sizes;
  std::size_t count = 0;
};

herr_t AppendName(hid_t, const char* name, const H5L_info_t* info, void* names) {
  if (info->type == H5L_TYPE_HARD) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

/// The names of the members of a group, without symbolic and external links.
std::vector<std::string> NamesIn(hid_t group) {
  std::vector<std::string> names;
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, AppendName, &names);
  return names;
}

/// Reads values, which may be nested and, in a damaged file, contain themselves.
class Reader {
 public:
  /// Without `with_numbers` only parts that lead to objects are read.
  Reader(hid_t file, bool with_numbers) : file_(file), with_numbers_(with_numbers) {}

  MatValue ValueAt(hobj_ref_t reference) {
    const Handle object(H5Rdereference2(file_, H5P_DEFAULT, H5R_OBJECT, &reference), H5Oclose);
    return object ? ValueOf(object.id()) : MatValue{};
  }

  MatValue ValueIn(hid_t group, const std::string& name) {
    const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    return object ? ValueOf(object.id()) : MatValue{};
  }

 private:
  MatValue ValueOf(hid_t object) {
    constexpr int kMaxValues = 100'000;
    if (depth_ == kDeepestValue || ++values_ > kMaxValues) return {};
    ++depth_;
    const H5I_type_t type = H5Iget_type(object);
    MatValue value = type == H5I_DATASET ? OfDataset(object) : type == H5I_GROUP ? OfGroup(object) : MatValue{};
    --depth_;
    return value;
  }

  /// The type in which MATLAB writes numbers of a class on every machine that supports these objects; negative for
  /// other classes.
  static hid_t TypeOf(const std::string& name) {
    const std::array<std::pair<std::string_view, hid_t>, 12> types = {{{"double", H5T_IEEE_F64LE},
                                                                       {"single", H5T_IEEE_F32LE},
                                                                       {"logical", H5T_STD_U8LE},
                                                                       {"char", H5T_STD_U16LE},
                                                                       {"int8", H5T_STD_I8LE},
                                                                       {"uint8", H5T_STD_U8LE},
                                                                       {"int16", H5T_STD_I16LE},
                                                                       {"uint16", H5T_STD_U16LE},
                                                                       {"int32", H5T_STD_I32LE},
                                                                       {"uint32", H5T_STD_U32LE},
                                                                       {"int64", H5T_STD_I64LE},
                                                                       {"uint64", H5T_STD_U64LE}}};
    const auto* const found = std::ranges::find(types, name, &std::pair<std::string_view, hid_t>::first);
    return found == types.end() ? H5I_INVALID_HID : found->second;
  }

  static Kind KindOf(const std::string& name) {
    if (name == "char") return Kind::kText;
    if (name == "canonical empty" || TypeOf(name) >= 0) return Kind::kNumbers;
    if (name == "cell") return Kind::kCells;
    return name == "struct" ? Kind::kStructure : Kind::kOther;
  }

  MatValue OfDataset(hid_t id) {
    constexpr int kOfClass = 3;
    const Dataset dataset(id);
    MatValue value;
    const std::string name = TextIn(id, "MATLAB_class");
    value.sizes = dataset.sizes;
    value.kind = NumberIn(id, "MATLAB_object_decode") == kOfClass ? Kind::kObject : KindOf(name);
    if (value.kind == Kind::kObject) value.text = name;
    const bool is_whole =
        NumberIn(id, "MATLAB_empty") != 0 ? ReadEmpty(dataset, value) : ReadArray(dataset, name, value);
    if (!is_whole) return {};
    return value;
  }

  /// An empty array stores its sizes as numbers.
  static bool ReadEmpty(const Dataset& dataset, MatValue& value) {
    if (!dataset.HasNumbers()) return false;
    const std::vector<std::uint64_t> sizes = dataset.Read<std::uint64_t>(H5T_NATIVE_UINT64);
    value.sizes.assign(sizes.begin(), sizes.end());
    return CountIn(value.sizes) == std::size_t{0};
  }

  bool ReadArray(const Dataset& dataset, const std::string& name, MatValue& value) {
    if (value.kind == Kind::kObject) {
      if (dataset.HasType(H5T_STD_U32LE)) value.numbers = dataset.Read<double>(H5T_NATIVE_DOUBLE);
      return true;
    }
    if (value.kind == Kind::kCells) {
      if (dataset.kind != H5T_REFERENCE) return false;
      const auto references = dataset.Read<hobj_ref_t>(H5T_STD_REF_OBJ);
      for (const hobj_ref_t reference : references) value.parts.push_back(ValueAt(reference));
      return references.size() == dataset.count;
    }
    if (!with_numbers_ || !dataset.HasType(TypeOf(name))) return false;
    if (value.kind == Kind::kNumbers) value.numbers = dataset.Read<double>(H5T_NATIVE_DOUBLE);
    if (value.kind != Kind::kText) return value.numbers.size() == dataset.count;
    for (const std::uint16_t letter : dataset.Read<std::uint16_t>(H5T_NATIVE_UINT16)) value.text += AsciiLetter(letter);
    return value.text.size() == dataset.count;
  }

  /// A structure of one element. In structures of several elements the fields contain references without a class.
  MatValue OfGroup(hid_t group) {
    MatValue value;
    if (KindOf(TextIn(group, "MATLAB_class")) != Kind::kStructure) return value;
    value.kind = Kind::kStructure;
    value.sizes = {1, 1};
    value.names = NamesIn(group);
    for (const std::string& name : value.names) value.parts.push_back(ValueIn(group, name));
    return value;
  }

  hid_t file_;
  bool with_numbers_;
  int depth_ = 0, values_ = 0;
};

void ReadReferences(hid_t file, MatSubsystem& subsystem) {
  Reader reader(file, false);
  for (const std::string& name : NamesIn(file)) {
    if (!name.starts_with('#')) AddReferences(reader.ValueIn(file, name), name, subsystem.references);
  }
}

std::optional<Mcos> TableAt(hid_t file, hobj_ref_t reference, std::size_t cells) {
  const Handle object(H5Rdereference2(file, H5P_DEFAULT, H5R_OBJECT, &reference), H5Oclose);
  if (!object || H5Iget_type(object.id()) != H5I_DATASET) return std::nullopt;
  const Dataset dataset(object.id());
  if (dataset.kind != H5T_INTEGER || TextIn(object.id(), "MATLAB_class") != "uint8") return std::nullopt;
  const std::vector<char> bytes = dataset.Read<char>(H5T_NATIVE_UINT8);
  return Mcos::Read({bytes.data(), bytes.size()}, cells);
}

void OpenCells(const std::shared_ptr<const Handle>& file, MatSubsystem& subsystem) {
  const Handle wrapper(H5Oopen(file->id(), "#subsystem#/MCOS", H5P_DEFAULT), H5Oclose);
  if (!wrapper || H5Iget_type(wrapper.id()) != H5I_DATASET) return;
  const Dataset dataset(wrapper.id());
  if (dataset.kind != H5T_REFERENCE || TextIn(wrapper.id(), "MATLAB_class") != "FileWrapper__") return;
  std::vector<hobj_ref_t> references = dataset.Read<hobj_ref_t>(H5T_STD_REF_OBJ);
  if (references.empty()) return;
  subsystem.objects = TableAt(file->id(), references.front(), references.size());
  subsystem.cells = references.size();
  subsystem.cell = [file, cells = std::move(references)](std::size_t i) {
    const MutedErrors silence;
    return i < cells.size() ? Reader(file->id(), true).ValueAt(cells[i]) : MatValue{};
  };
}

}  // namespace

std::function<MatSubsystem()> OpenHdf5(const std::string& path) {
  const MutedErrors silence;
  const auto file = std::make_shared<const Handle>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  return [file] {
    MatSubsystem subsystem;
    if (!*file) return subsystem;
    const MutedErrors quiet;
    ReadReferences(file->id(), subsystem);
    OpenCells(file, subsystem);
    return subsystem;
  };
}

}  // namespace pendulum
