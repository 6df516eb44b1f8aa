#include "step_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelIndexedMap.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <UnitsMethods_LengthUnit.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "dowel/io/file.h"
#include "dowel/io/import.h"
#include "dowel/kernel/tolerance.h"
#include "occt.h"
#include "part_names.h"
#include "step_definitions.h"

namespace dowel {
namespace {

constexpr std::size_t kMostWarnings = 20;

/// A message of OpenCascade without its frame of stars and the names of its own parts.
std::string plain_message(const TCollection_AsciiString& message) {
  std::string text = clean_text({message.ToCString(), static_cast<std::size_t>(message.Length())});
  constexpr const char* kFrame = "* ";
  text.erase(0, std::min(text.find_first_not_of(kFrame), text.size()));
  text.erase(text.find_last_not_of(kFrame) + 1);
  for (const std::string_view prefix : {"ERR StepFile : ", "Undefined Parsing: "}) {
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  }
  return text;
}

/// Keeps what OpenCascade would print. Its default printer writes to standard output.
class CollectingPrinter : public Message_Printer {
  DEFINE_STANDARD_RTTI_INLINE(CollectingPrinter, Message_Printer)
 public:
  const std::vector<std::string>& lines() const noexcept { return lines_; }

 protected:
  void send(const TCollection_AsciiString& text, Message_Gravity gravity) const override {
    if (gravity < Message_Warning || lines_.size() >= kMostWarnings) return;
    const std::string line = plain_message(text);
    if (!line.empty()) lines_.push_back(line);
  }

 private:
  mutable std::vector<std::string> lines_;
};

/// Statics are shared by everything in the process that reads STEP: set all that matter each time.
void set_reader_options(bool is_utf8) {
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("read.stepcaf.codepage", is_utf8 ? "UTF8" : "CP1252");
  Interface_Static::SetIVal("read.precision.mode", 0);
  Interface_Static::SetIVal("read.step.product.mode", 1);
  Interface_Static::SetIVal("read.step.assembly.level", 1);
}

std::size_t count_of(std::string_view text, std::string_view keyword) {
  std::size_t count = 0;
  for (auto at = text.find(keyword); at != text.npos; at = text.find(keyword, at + 1)) ++count;
  return count;
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string joined(const std::vector<std::string>& items, const std::string& separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

/// An assembly that is spread over files has one of these for each of the others.
constexpr std::string_view kFileReference = "=DOCUMENT_FILE(";

/// What a file says it holds that the transfer gives no shape for.
std::string untransferred(std::string_view text) {
  std::vector<std::string> kinds;
  const auto look_for = [&](std::string_view keyword, const std::string& thing) {
    const std::size_t count = count_of(text, keyword);
    if (count > 0) kinds.push_back(counted(count, thing));
  };
  look_for("=TESSELLATED_SOLID(", "tessellated solid");
  look_for("=TESSELLATED_SHELL(", "tessellated shell");
  look_for("=TRIANGULATED_FACE(", "triangulated face");
  look_for("=COMPLEX_TRIANGULATED_FACE(", "triangulated face");
  look_for("=GEOMETRIC_CURVE_SET(", "curve set");
  look_for(kFileReference, "external reference");
  return joined(kinds, ", ");
}

std::string without_spaces(std::string_view text) {
  std::string compact;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) compact += c;
  }
  return compact;
}

std::string unit_symbol(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::map<std::string, std::string> kSymbols{
      {"millimetre", "mm"}, {"millimeter", "mm"}, {"metre", "m"},       {"meter", "m"},
      {"centimetre", "cm"}, {"centimeter", "cm"}, {"kilometre", "km"},  {"kilometer", "km"},
      {"micrometre", "um"}, {"micrometer", "um"}, {"inch", "inch"},     {"inches", "inch"},
      {"in", "inch"},       {"foot", "foot"},     {"feet", "foot"},     {"ft", "foot"},
      {"mil", "mil"},       {"microinch", "uin"}, {"micro inch", "uin"}};
  const auto symbol = kSymbols.find(name);
  return symbol == kSymbols.end() ? clean_text(name) : symbol->second;
}

std::string file_unit(STEPCAFControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths;
  TColStd_SequenceOfAsciiString angles;
  TColStd_SequenceOfAsciiString solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  std::vector<std::string> units;
  for (const TCollection_AsciiString& name : lengths) {
    const std::string unit = unit_symbol(name.ToCString());
    if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
  }
  return joined(units, "+");
}

/// Fails of the load and the transfer, as "#12: message".
std::vector<std::string> failed_checks(STEPCAFControl_Reader& reader) {
  std::vector<std::string> found;
  const auto model = reader.Reader().StepModel();
  const auto session = reader.Reader().WS();
  const auto gather = [&](Interface_CheckIterator&& checks) {
    for (checks.Start(); checks.More() && found.size() < kMostWarnings; checks.Next()) {
      const auto& check = checks.Value();
      if (!check->HasFailed()) continue;
      const int number = checks.Number();
      const std::string where = number > 0
                                    ? "#" + std::to_string(model->IdentLabel(model->Value(number)))
                                    : std::string("file");
      found.push_back(where + ": " + clean_text(check->CFail(1)));
    }
  };
  gather(session->ModelCheckList(false));
  gather(session->TransferReader()->LastCheckList());
  return found;
}

/// Walks the document's tree of assemblies and collects its distinct parts.
class PartCollector {
 public:
  explicit PartCollector(const opencascade::handle<TDocStd_Document>& document)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())) {}

  /// Each distinct part once, and all its places.
  void collect(StepContent& content) {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) visit(root, gp_Trsf(), "");
    content.parts = std::move(parts_);
    content.instances = std::move(instances_);
    if (visits_ >= kMaxInstances) {
      content.warnings.push_back("places more than " + std::to_string(kMaxInstances) +
                                 " parts and assemblies; only the first are kept");
    }
    if (distorted_ > 0) {
      content.warnings.push_back(counted(distorted_, "instance") +
                                 " mirrored or scaled by the assembly; left out");
    }
  }

  /// All roots placed, as one part with the name of the only root, or none. An assembly has no
  /// colour: its parts have.
  StepPart whole() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    StepPart part;
    if (roots.Length() == 1) {
      part.name = name_of(roots.First());
      if (!shapes_->IsAssembly(roots.First())) {
        part.colour = colour_of(roots.First(), shapes_->GetShape(roots.First()));
      }
    }
    BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    for (const TDF_Label& root : roots) {
      const TopoDS_Shape shape = shapes_->GetShape(root);
      if (!shape.IsNull()) builder.Add(compound, shape);
    }
    part.shape = compound;
    return part;
  }

 private:
  /// `X_WL`: where the frame of `label` lies. `owner`: name for a part that has none. Assemblies of
  /// assemblies can place more parts than anybody can count: once there are too many, only what is
  /// new is looked at.
  void visit(const TDF_Label& label, const gp_Trsf& X_WL, const std::string& owner) {
    TDF_Label target = label;
    if (shapes_->IsReference(label)) shapes_->GetReferredShape(label, target);
    const bool is_known = seen_.Contains(target);
    if (is_known && visits_ >= kMaxInstances) return;
    ++visits_;
    const auto index = static_cast<std::size_t>(seen_.Add(target)) - 1;
    if (!is_known) part_of_.emplace_back();
    if (shapes_->IsAssembly(target)) {
      TDF_LabelSequence components;
      shapes_->GetComponents(target, components);
      const std::string name = is_known ? "" : name_for_only_solid(target, components);
      for (const TDF_Label& component : components) {
        visit(component, X_WL * XCAFDoc_ShapeTool::GetLocation(component).Transformation(), name);
      }
      return;
    }
    const TopoDS_Shape shape = shapes_->GetShape(target);
    if (shape.IsNull()) return;
    if (!is_known) {
      part_of_[index] = parts_.size();
      std::string name = name_of(target);
      if (!is_usable_name(name) && !owner.empty()) name = owner;
      parts_.push_back({std::move(name), shape, colour_of(target, shape)});
    }
    add_instance(label, part_of_[index].value(), X_WL);
  }

  /// The name of an assembly that has one solid and else only surfaces or curves: some systems
  /// write a part so, and name the assembly alone.
  std::string name_for_only_solid(const TDF_Label& assembly,
                                  const TDF_LabelSequence& components) const {
    int with_solids = 0;
    for (const TDF_Label& component : components) {
      if (shapes_->IsAssembly(component)) return "";
      const TopoDS_Shape shape = shapes_->GetShape(component);
      if (TopExp_Explorer(shape, TopAbs_SOLID).More()) ++with_solids;
    }
    return with_solids == 1 ? name_of(assembly) : "";
  }

  void add_instance(const TDF_Label& label, std::size_t part, const gp_Trsf& X_WL) {
    if (instances_.size() >= kMaxInstances) return;
    if (std::abs(X_WL.ScaleFactor() - 1.0) > kUnitVectorSlack) {  // a mirror's is -1
      ++distorted_;
      return;
    }
    const gp_Quaternion q = X_WL.GetRotation();
    const gp_XYZ& t = X_WL.TranslationPart();
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized();
    instances_.push_back(
        {name_of(label), part, Pose(rotation, Eigen::Vector3d(t.X(), t.Y(), t.Z()))});
  }

  static std::string name_of(const TDF_Label& label) {
    opencascade::handle<TDataStd_Name> name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    const TCollection_ExtendedString& text = name->Get();
    std::string utf8(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
    Standard_PCharacter begin = utf8.data();
    text.ToUTF8CString(begin);
    utf8.resize(std::min(utf8.size(), utf8.find('\0')));
    return clean_text(decode_step_text(utf8));
  }

  std::optional<std::array<double, 3>> colour_of(const TDF_Label& label,
                                                 const TopoDS_Shape& shape) const {
    Quantity_Color colour;
    bool found = false;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
      found = found || colours_->GetColor(label, type, colour) ||
              colours_->GetColor(shape, type, colour);
      // Many exporters colour the solid inside the part.
      TopExp_Explorer solid(shape, TopAbs_SOLID);
      found = found || (solid.More() && colours_->GetColor(solid.Current(), type, colour));
    }
    if (!found) return std::nullopt;
    std::array<double, 3> srgb{};
    colour.Values(srgb[0], srgb[1], srgb[2], Quantity_TOC_sRGB);
    for (double& channel : srgb) channel = std::clamp(channel, 0.0, 1.0);
    return srgb;
  }

  opencascade::handle<XCAFDoc_ShapeTool> shapes_;
  opencascade::handle<XCAFDoc_ColorTool> colours_;
  TDF_LabelIndexedMap seen_;                         ///< parts and assemblies
  std::vector<std::optional<std::size_t>> part_of_;  ///< of each of them
  std::vector<StepPart> parts_;
  std::vector<StepInstance> instances_;
  std::size_t visits_ = 0;
  std::size_t distorted_ = 0;
};

std::size_t count_outside(const TopoDS_Shape& shape, TopAbs_ShapeEnum what,
                          TopAbs_ShapeEnum outside) {
  std::size_t count = 0;
  for (TopExp_Explorer it(shape, what, outside); it.More(); it.Next()) ++count;
  return count;
}

struct Leftovers {
  std::size_t open_shells = 0;
  std::size_t faces = 0;
  std::size_t edges = 0;
  std::size_t vertices = 0;

  std::string text() const {
    std::vector<std::string> kinds;
    if (open_shells > 0) kinds.push_back(counted(open_shells, "open shell"));
    if (faces > 0) kinds.push_back(counted(faces, "loose face"));
    if (edges > 0) kinds.push_back(counted(edges, "curve"));
    if (vertices > 0) kinds.push_back(counted(vertices, "point"));
    return joined(kinds, ", ");
  }
};

/// The solids of `shape` and its closed loose shells as solids, in one compound; null where there
/// is none. What remains is added to `leftovers`.
TopoDS_Shape solids_of(const TopoDS_Shape& shape, Leftovers& leftovers) {
  BRep_Builder builder;
  TopoDS_Compound solids;
  builder.MakeCompound(solids);
  bool any = false;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    builder.Add(solids, it.Current());
    any = true;
  }
  for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next()) {
    BRepBuilderAPI_MakeSolid solid;
    if (BRep_Tool::IsClosed(it.Current())) solid.Add(TopoDS::Shell(it.Current()));
    if (BRep_Tool::IsClosed(it.Current()) && solid.IsDone()) {
      builder.Add(solids, solid.Solid());
      any = true;
    } else {
      ++leftovers.open_shells;
    }
  }
  leftovers.faces += count_outside(shape, TopAbs_FACE, TopAbs_SHELL);
  leftovers.edges += count_outside(shape, TopAbs_EDGE, TopAbs_FACE);
  leftovers.vertices += count_outside(shape, TopAbs_VERTEX, TopAbs_EDGE);
  return any ? TopoDS_Shape(solids) : TopoDS_Shape();
}

/// Leaves the parts that have solids, and their instances.
void keep_solids(StepContent& content) {
  Leftovers leftovers;
  std::vector<StepPart> parts;
  std::vector<std::optional<std::size_t>> new_index;
  for (StepPart& part : content.parts) {
    part.shape = solids_of(part.shape, leftovers);
    new_index.emplace_back();
    if (part.shape.IsNull()) continue;
    new_index.back() = parts.size();
    parts.push_back(std::move(part));
  }
  content.parts = std::move(parts);
  std::erase_if(content.instances,
                [&](const StepInstance& instance) { return !new_index[instance.part]; });
  for (StepInstance& instance : content.instances) instance.part = *new_index[instance.part];
  content.leftovers = leftovers.text();
}

[[noreturn]] void fail_to_read(const std::string& what, const std::vector<std::string>& messages) {
  throw Error(ErrorCode::FileMalformed, what + (messages.empty() ? "" : ": " + messages.front()));
}

StepContent read(const std::filesystem::path& file, const std::string& text, bool whole_file,
                 const std::function<void(WorkerStage)>& report) {
  const opencascade::handle<CollectingPrinter> printer = new CollectingPrinter;
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  Message::DefaultMessenger()->AddPrinter(printer);
  set_reader_options(is_utf8(text));

  STEPCAFControl_Reader reader;
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) {
    fail_to_read("the STEP reader refuses it", printer->lines());
  }
  report(WorkerStage::Transfer);
  StepContent content;
  content.unit = file_unit(reader);
  const bool has_roots = reader.NbRootsForTransfer() > 0;
  opencascade::handle<TDocStd_Document> document = new TDocStd_Document("XmlXCAF");
  XCAFDoc_ShapeTool::SetAutoNaming(false);
  XCAFDoc_DocumentTool::SetLengthUnit(document, 1.0, UnitsMethods_LengthUnit_Millimeter);
  const bool transferred = has_roots && reader.Transfer(document);
  content.warnings = failed_checks(reader);

  PartCollector collector(document);
  if (transferred && whole_file) {
    content.parts.push_back(collector.whole());
    content.instances.push_back({content.parts.front().name, 0, Pose()});
  }
  if (transferred && !whole_file) collector.collect(content);
  keep_solids(content);
  const std::string compact = without_spaces(text);
  if (!content.parts.empty() || !content.leftovers.empty()) {
    const std::size_t references = count_of(compact, kFileReference);
    if (references > 0) {
      content.warnings.push_back("has " + counted(references, "external reference") +
                                 ": parts in other files may be missing");
    }
    const std::size_t unused = unused_definitions(compact);
    if (unused > 0) {
      content.warnings.push_back(std::to_string(unused) +
                                 " placements or shapes of parts are used by nothing");
    }
    return content;
  }
  content.leftovers = untransferred(compact);
  if (content.leftovers.empty() && !content.warnings.empty()) {
    fail_to_read("nothing in it can be transferred", content.warnings);
  }
  return content;
}

}  // namespace

StepContent read_step(const std::filesystem::path& file, bool whole_file,
                      const std::function<void(WorkerStage)>& report) {
  report(WorkerStage::Read);
  const std::string text = read_file(file);
  if (text.empty()) throw Error(ErrorCode::FileMalformed, "is empty, expected a STEP file");
  constexpr std::size_t kHeader = 4096;
  if (std::string_view(text).substr(0, kHeader).find("ISO-10303-21") == std::string_view::npos) {
    throw Error(ErrorCode::FileMalformed,
                "not a STEP file: expected \"ISO-10303-21\" at its beginning");
  }
  return guarded("the STEP reader failed", [&] { return read(file, text, whole_file, report); });
}

}  // namespace dowel
