// dowel catalog sheet.

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "catalog_commands.h"
#include "dowel/catalog/catalog.h"
#include "dowel/catalog/search.h"
#include "dowel/io/catalog_sheet.h"
#include "dowel/kernel/error.h"
#include "json.h"
#include "progress.h"
#include "table.h"

namespace dowel::tools {

void add_sheet_command(CLI::App& catalog) {
  struct Arguments {
    std::string file;
    std::string output;
    std::vector<std::string> terms;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = catalog.add_subcommand(
      "sheet",
      "Writes one HTML page with pictures and data of all elements, or of those that match "
      "(terms as for search).");
  command->footer("Example: dowel catalog sheet elements.db risers.html riser 'height>=80'");
  command->add_option("CATALOG.db", arguments->file)->required();
  command->add_option("OUT.html", arguments->output, "the page; replaced where it exists")
      ->required();
  command->add_option("TERM", arguments->terms, "riser, 'height>=80', hole=12, \"hole M12\"");
  command->callback([arguments] {
    const SearchQuery query = parse_query(arguments->terms);
    const Catalog elements(arguments->file, Catalog::Access::ReadOnly);
    const std::vector<Element> found = search(elements, query);
    if (found.empty()) {
      throw Error(ErrorCode::NotFound, arguments->file + ": no element to draw" +
                                           (arguments->terms.empty() ? "" : " matches"));
    }
    Progress progress("elements");
    write_sheet(arguments->output, elements, found, [&](std::size_t done, std::size_t total) {
      progress.update(done, total, "");
      return true;
    });
    progress.clear();
    print_line(counted(found.size(), "element") + " drawn in " + printable(arguments->output));
  });
}

}  // namespace dowel::tools
