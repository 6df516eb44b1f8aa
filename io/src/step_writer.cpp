#include "dowel/io/step_writer.h"

#include <functional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BinTools.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

#include "dowel/io/file.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "occt.h"
#include "step_text.h"
#include "worker.h"

namespace dowel {
namespace {

/// Everything about the STEP writer that is global to the process and shows in the file.
void configure_writer() {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetIVal("write.surfacecurve.mode", 1);
  Interface_Static::SetIVal("write.precision.mode", 0);
  Interface_Static::SetIVal("write.step.nonmanifold", 0);
  XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
}

TopoDS_Shape read_brep(const ExportPart& part) {
  const std::string bytes(reinterpret_cast<const char*>(part.brep.data()), part.brep.size());
  std::istringstream stream(bytes);
  TopoDS_Shape shape;
  BinTools::Read(shape, stream);
  if (shape.IsNull()) {
    throw Error(ErrorCode::FileMalformed,
                "the boundary representation of part '" + part.name + "' is damaged");
  }
  return shape;
}

gp_Trsf to_trsf(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  gp_Trsf trsf;
  trsf.SetTransformation(gp_Quaternion(q.x(), q.y(), q.z(), q.w()), gp_Vec(t.x(), t.y(), t.z()));
  return trsf;
}

void set_name(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), Standard_True));
}

/// An XCAF document that leaves the process's application when it goes.
class StepDocument {
 public:
  StepDocument() {
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colours_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }
  StepDocument(const StepDocument&) = delete;
  StepDocument& operator=(const StepDocument&) = delete;
  ~StepDocument() { XCAFApp_Application::GetApplication()->Close(document_); }

  /// Adds `part` and returns its label and where its shape stands in the part's frame.
  std::pair<TDF_Label, TopLoc_Location> add_part(const ExportPart& part) {
    const TopoDS_Shape shape = read_brep(part);
    // A located shape would become a reference to another product.
    const TDF_Label label =
        shapes_->AddShape(shape.Located(TopLoc_Location()), Standard_False, Standard_False);
    set_name(label, part.name);
    if (part.colour) {
      const auto& [red, green, blue] = *part.colour;
      colours_->SetColor(label, Quantity_Color(red, green, blue, Quantity_TOC_sRGB),
                         XCAFDoc_ColorSurf);
    }
    return {label, shape.Location()};
  }

  TDF_Label add_assembly(const std::string& name) {
    const TDF_Label label = shapes_->NewShape();
    set_name(label, name);
    return label;
  }

  void add_component(const TDF_Label& assembly, const TDF_Label& part,
                     const TopLoc_Location& location, const std::string& name) {
    set_name(shapes_->AddComponent(assembly, part, location), name);
  }

  /// The document as the text of a STEP file.
  std::string to_step(const std::string& name) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    if (!writer.Transfer(document_, STEPControl_AsIs)) {
      throw Error(ErrorCode::InvalidInput, "cannot be expressed as STEP");
    }
    const Handle(StepData_StepModel) model = writer.ChangeWriter().Model();
    set_header(model, name);
    number_occurrences(model);
    StepData_StepWriter text(model);
    // Fifteen significant digits, so that decimals read as they were meant: at 10 m a placement is
    // right to 1e-11 mm, a direction's end to 1e-9 mm. The writer's own default keeps twelve, and
    // its suppression of zeros loses the exponent of numbers as long as these.
    text.FloatWriter().SetFormat("%.14E");
    text.FloatWriter().SetFormatForRange("%.13f", 0.1, 100.0);
    text.FloatWriter().SetZeroSuppress(Standard_False);
    text.SendModel(Handle(StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol()));
    std::ostringstream stream;
    text.Print(stream);
    return tidy_step_text(std::move(stream).str());
  }

 private:
  static Handle(TCollection_HAsciiString) text(const char* value) {
    return new TCollection_HAsciiString(value);
  }

  /// A header without clock, host, path or program version: the same assembly, the same bytes.
  static void set_header(const Handle(StepData_StepModel) & model, const std::string& name) {
    APIHeaderSection_MakeHeader header(model);
    header.SetName(text(name.c_str()));
    header.SetTimeStamp(text("1970-01-01T00:00:00"));
    header.SetAuthorValue(1, text(""));
    header.SetOrganizationValue(1, text(""));
    header.SetPreprocessorVersion(text("dowel"));
    header.SetOriginatingSystem(text("dowel"));
    header.SetAuthorisation(text(""));
    header.SetDescriptionValue(1, text("dowel model"));
    header.SetImplementationLevel(text("2;1"));
  }

  /// The writer numbers occurrences through the life of the process: count from one in each file.
  static void number_occurrences(const Handle(StepData_StepModel) & model) {
    int count = 0;
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const auto occurrence =
          Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
      if (!occurrence.IsNull()) occurrence->SetId(text(std::to_string(++count).c_str()));
    }
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
};

/// What `write` returns, from a child process: reading a damaged brep can crash, and both the brep
/// reader and the STEP writer leave state and words behind. `name` is what errors tell of.
std::string write_in_child(const std::string& name, const std::function<std::string()>& write) {
  std::string content;
  const auto task = [&](std::size_t, const std::function<void(WorkerStage)>&) {
    const std::string text = guarded("its geometry cannot be written", write);
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return std::vector<std::byte>(first, first + text.size());
  };
  run_workers(1, 1, {}, task, [&](std::size_t, WorkerOutcome&& outcome) {
    if (!outcome.failure.empty()) {
      throw Error(ErrorCode::FileMalformed, "'" + name + "': " + outcome.failure);
    }
    content.assign(reinterpret_cast<const char*>(outcome.output.data()), outcome.output.size());
    return true;
  });
  return content;
}

}  // namespace

void write_step_assembly(const std::filesystem::path& file, const std::string& name,
                         const std::vector<ExportPart>& parts,
                         const std::vector<ExportInstance>& instances) {
  for (const ExportInstance& instance : instances) DOWEL_EXPECTS(instance.part < parts.size());
  if (instances.empty()) {
    throw Error(ErrorCode::InvalidInput, "'" + name + "': has no instance to export");
  }
  const std::string content = write_in_child(name, [&] {
    configure_writer();
    StepDocument document;
    const TDF_Label assembly = document.add_assembly(name);
    std::vector<std::pair<TDF_Label, TopLoc_Location>> labels(parts.size());
    for (const ExportInstance& instance : instances) {
      auto& [label, shape_location] = labels[instance.part];
      if (label.IsNull()) std::tie(label, shape_location) = document.add_part(parts[instance.part]);
      document.add_component(
          assembly, label, TopLoc_Location(to_trsf(instance.X_WI)) * shape_location, instance.name);
    }
    return document.to_step(name);
  });
  write_file(file, content);
}

void write_step_part(const std::filesystem::path& file, const ExportPart& part) {
  const std::string content = write_in_child(part.name, [&] {
    configure_writer();
    StepDocument document;
    document.add_part(part);
    return document.to_step(part.name);
  });
  write_file(file, content);
}

}  // namespace dowel
