#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>

namespace dowel::testing {

/// Writes shapes as roots of a STEP file by OpenCascade, whose numbers are millimetres; `unit` is
/// the unit in the file.
inline void write_step(const std::filesystem::path& file, const std::vector<TopoDS_Shape>& shapes,
                       const char* unit = "MM") {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPControl_Controller::Init();  // else the settings do not exist yet
  Interface_Static::SetCVal("write.step.unit", unit);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  STEPControl_Writer writer;  // takes the unit as it is now
  for (const TopoDS_Shape& shape : shapes) writer.Transfer(shape, STEPControl_AsIs);
  const bool is_written = writer.Write(file.c_str()) == IFSelect_RetDone;
  Interface_Static::SetCVal("write.step.unit", "MM");
  if (!is_written) throw std::runtime_error("cannot write " + file.string());
}

/// A plate of 60 x 40 x 10 mm with a through bore of 12 mm diameter at (20, 20).
inline TopoDS_Shape drilled_plate() {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(60.0, 40.0, 10.0).Shape();
  const gp_Ax2 axis(gp_Pnt(20.0, 20.0, -5.0), gp::DZ());
  return BRepAlgoAPI_Cut(plate, BRepPrimAPI_MakeCylinder(axis, 6.0, 20.0).Shape()).Shape();
}

/// `text` with every `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace dowel::testing
