#include <algorithm>
#include <array>

#include "exchange/decoding.h"
#include "exchange/parsers.h"

namespace softland::internal {
namespace {

struct KindRow {
  std::string_view begin;  ///< text, after blanks, with which one of the first lines of a file of kind `what` begins
  std::string_view what;
};
constexpr std::array kinds{
    KindRow{"% Model", "a field on the nodes of a mesh (COMSOL)"},
    KindRow{"1C", "a mesh with results (CalculiX)"},
    KindRow{"1UUSER", "a mesh with results (CalculiX)"},
    KindRow{"*NODE", "a mesh (Abaqus or CalculiX input)"},
    KindRow{"*HEADING", "a mesh (Abaqus or CalculiX input)"},
    KindRow{"$MeshFormat", "a mesh (Gmsh)"},
    KindRow{"# vtk DataFile", "a mesh (VTK)"},
    KindRow{"solid ", "a surface (STL)"},
    KindRow{"{\"", "JSON"},
    KindRow{"<?xml", "XML"},
    KindRow{"<html", "a page"},
    KindRow{"<!DOCTYPE", "a page"},
    KindRow{"%PDF", "a PDF"},
    KindRow{"PK\x03\x04", "an archive or a workbook of a spreadsheet: export it as CSV"},
    KindRow{"\x89PNG", "a picture"},
};

}  // namespace

std::string refused_kind(std::string_view text) {
  constexpr std::size_t looked_at = 5;
  Lines lines(text.substr(0, 4096));
  for (std::size_t i = 0; i < looked_at && lines.next(); ++i) {
    std::string_view line = lines.line();
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    for (const KindRow& row : kinds) {
      if (line.starts_with(row.begin)) return std::string(row.what);
    }
  }
  return {};
}

}  // namespace softland::internal
