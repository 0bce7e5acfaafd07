// SPDX-License-Identifier: Apache-2.0
// No message about a file blames another format than its own.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/readers/content.h"
#include "tests/recording/rows.h"
#include "tests/recording/xls_files.h"
#include "tests/recording/zip_files.h"

namespace pendulum::foreign_content_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using std::string_literals::operator""s;

/// A file by its beginning, and a part of the message about it.
struct Example {
  std::string name, bytes, named;
};

const std::string kZeros(600, '\0');

std::vector<Example> Binaries() {
  return {
      {"photo.jpg", "\xFF\xD8\xFF\xE0\0\x10JFIF\0"s + kZeros, "this is a picture"},
      {"plot.png", "\x89PNG\r\n\x1A\n\0\0\0\rIHDR"s + kZeros, "this is a picture"},
      {"plot.gif", "GIF89a\x40\1"s + kZeros, "this is a picture"},
      {"plot.bmp", "BM\x36\0\0\0\0\0\0\0"s + kZeros, "this is a picture"},
      {"plot.tif", "II*\0\x08\0\0\0"s + kZeros, "this is a picture"},
      {"big_endian.tif", "MM\0*\0\0\0\x08"s + kZeros, "this is a picture"},
      {"photo.heic", "\0\0\0\x24"s + "ftypheic\0\0\0\0"s + kZeros, "this is a picture"},
      {"plot.webp", "RIFF\x24\0\0\0WEBPVP8 "s + kZeros, "this is a picture"},
      {"swing.mp4", "\0\0\0\x18"s + "ftypmp42\0\0\0\0"s + kZeros, "this is a video"},
      {"swing.mov", "\0\0\0\x14"s + "ftypqt  "s + kZeros, "this is a video"},
      {"swing.avi", "RIFF\x24\0\0\0AVI LIST"s + kZeros, "this is a video"},
      {"swing.webm", "\x1A\x45\xDF\xA3\x9F"s + kZeros, "this is a video"},
      {"swing.wmv", "\x30\x26\xB2\x75\x8E\x66\xCF\x11\xA6\xD9"s + kZeros, "this is a video"},
      {"swing.wav", "RIFF\x24\0\0\0WAVEfmt "s + kZeros, "this is a sound file"},
      {"swing.ogg", "OggS\0\2"s + kZeros, "this is a sound file"},
      {"swing.mp3", "ID3\3\0\0"s + kZeros, "this is a sound file"},
      {"swing.m4a", "\0\0\0\x18"s + "ftypM4A "s + kZeros, "this is a sound file"},
      {"report.pdf", "%PDF-1.7\n", "this is a PDF"},
      {"report.rtf", "{\\rtf1\\ansi", "this is a text document (RTF)"},
      {"run.tdms", "TDSm\x0E\0\0\0"s + kZeros, "this is a TDMS file of LabVIEW"},
      {"run.bag", "#ROSBAG V2.0\n", "this is a ROS bag"},
      {"run.mcap", "\x89MCAP0\r\n", "this is an MCAP log"},
      {"run.db3", "SQLite format 3\0"s + kZeros, "this is an SQLite file, such as a bag of ROS 2"},
      {"run.parquet", "PAR1\x15\x04"s + kZeros, "this is a table of Apache Arrow or Parquet"},
      {"run.feather", "ARROW1\0\0"s + kZeros, "this is a table of Apache Arrow or Parquet"},
      {"run.pkl", "\x80\x04\x95\x1A\0\0\0"s + kZeros, "this is a pickle of Python"},
      {"run.h5", "\x89HDF\r\n\x1A\n"s + kZeros, "this is an HDF5 file"},
      {"run.rda", "RDX3\nX\n", "this is a file of R"},
      {"run.mf4", "MDF     4.10    "s + kZeros, "this is a measurement file (MDF)"},
      {"run.csv.gz", "\x1F\x8B\x08\0"s + kZeros, "this is a gzip file; unpack it"},
      {"run.csv.xz", "\xFD"s + "7zXZ\0"s + kZeros, "this is an xz file; unpack it"},
      {"run.csv.bz2", "BZh91AY"s + kZeros, "this is a bzip2 file; unpack it"},
      {"run.7z", "7z\xBC\xAF\x27\x1C"s + kZeros, "this is a 7z file; unpack it"},
      {"run.rar", "Rar!\x1A\7\0"s + kZeros, "this is a RAR file; unpack it"},
      {"run.zst", "\x28\xB5\x2F\xFD"s + kZeros, "this is a packed file; unpack it"},
      {"run.tar", "run.csv" + std::string(250, '\0') + "ustar\0"s + kZeros, "this is a tar file; unpack it"},
      {"a.out", "\x7F"s + "ELF\2\1\1"s + kZeros, "this is a program"},
      {"setup.exe", "MZ\x90\0\3\0"s + kZeros, "this is a program"},
      {"excel4.xls", "\x09\4\6\0\0\0\x10\0"s + kZeros, "this is a workbook of Excel 4"},
  };
}

std::vector<Example> Documents() {
  const std::string odf = "application/vnd.oasis.opendocument.";
  return {
      {"report.docx", ZipOf({{"[Content_Types].xml", "x"}, {"word/document.xml", "x"}}), "a text document (.docx)"},
      {"talk.pptx", ZipOf({{"[Content_Types].xml", "x"}, {"ppt/presentation.xml", "x"}}), "a presentation (.pptx)"},
      {"run.xlsb", ZipOf({{"[Content_Types].xml", "x"}, {"xl/workbook.bin", "x"}}), "a binary workbook (.xlsb)"},
      {"report.odt", ZipOf({{"mimetype", odf + "text"}, {"content.xml", "x"}}), "a text document (.odt)"},
      {"talk.odp", ZipOf({{"mimetype", odf + "presentation"}}), "a document of OpenDocument"},
      {"run.numbers", ZipOf({{"Index/Document.iwa", "x"}, {"preview.jpg", "x"}}), "a document of Numbers"},
      {"run.cap", ZipOf({{"main.xml", "<x/>"}, {"data/0001", "x"}}), "a project of PASCO Capstone (.cap)"},
      {"run.ggb", ZipOf({{"geogebra.xml", "<x/>"}}), "a GeoGebra construction"},
      {"report.doc", CompoundFileOf({{"WordDocument", "x"}}), "a text document (.doc)"},
      {"secret.xlsx", CompoundFileOf({{"EncryptionInfo", "x"}, {"EncryptedPackage", "x"}}), "is encrypted"},
      {"mail.msg", CompoundFileOf({{"__properties_version1.0", "x"}}), "a document of an Office program"},
      {"run.trk",
       "<?xml version=\"1.0\" encoding=\"UTF-8\"?><object "
       "class=\"org.opensourcephysics.cabrillo.tracker.TrackerPanel\">",
       "a project of Tracker (.trk)"},
      {"run.cmbl", "<Document><DocumentVersion>1</DocumentVersion><DataSet></DataSet></Document>",
       "a project of Logger Pro (.cmbl)"},
      {"plot.svg", "\n <svg xmlns=\"x\"><path d=\"M0\"/></svg>", "this is a picture"},
      {"other.xml", "\xEF\xBB\xBF<?xml version=\"1.0\"?><measurement><a/></measurement>",
       "this is XML (its first element is \"measurement\")"},
      {"report.xls", "<html><body><table><tr><td>1</td></tr></table></body></html>", "this is a web page (HTML)"},
      {"export.xls", "\xEF\xBB\xBF\r\n<!DOCTYPE HTML PUBLIC \"-//W3C//DTD\"><HTML>", "this is a web page (HTML)"},
      {"table.xls", "<TABLE border=1><tr>", "this is a web page (HTML)"},
  };
}

TEST(ForeignContent, IsNamedRightlyAndSaysWhatToDo) {
  std::vector<Example> all = Binaries();
  for (const Example& each : Documents()) all.push_back(each);
  for (const Example& each : all) {
    SCOPED_TRACE(each.name);
    const std::string message = FaultOf(each.bytes);
    EXPECT_THAT(message, StartsWith("run.csv: this "));
    EXPECT_THAT(message, HasSubstr(each.named));
    EXPECT_NE(message.find("; "), std::string::npos) << message;
    EXPECT_EQ(message.find("CSV text"), std::string::npos) << message;
  }
}

TEST(ForeignContent, IsNamedInAZipFileToo) {
  for (const Example& each : Binaries()) {
    EXPECT_THAT(FaultOf(ZipOf({{each.name, each.bytes}})), HasSubstr(each.named)) << each.name;
  }
}

TEST(ForeignContent, DoesNotHideTheRecordingBesideIt) {
  std::vector<std::pair<std::string, std::string>> members = {{"run.csv", "time_s,angle_rad\n" + Rows("0.0{t},{v}")}};
  for (const Example& each : Binaries()) members.push_back({each.name, each.bytes});
  ExpectTheRows(RecordingOf(ZipOf(members)));
}

TEST(ForeignContent, IsNotSeenInTables) {
  for (const char* const begin :
       {"MZ,angle\n", "BM;x\n", "ID,time\n", "RIFFLE,x\n", "<12,34>\n", "II,MM\n", "PARTS,1\n", "moov,x\n", "{1,2}\n",
        "[s]\t[deg]\n", "GIF,x\n", "# <xml>\n", "< 5 deg\n"}) {
    EXPECT_EQ(ContentOf(begin), Content::kText) << begin;
  }
}

}  // namespace
}  // namespace pendulum::foreign_content_test
