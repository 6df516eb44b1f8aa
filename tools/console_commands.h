#pragma once

// What the words of the console do. Each reads its arguments to the end before it acts.

#include "console.h"

namespace dowel::tools {

Reply run_catalog(Console& console, Arguments& arguments);
Reply run_new(Console& console, Arguments& arguments);
Reply run_open(Console& console, Arguments& arguments);
Reply run_save(Console& console, Arguments& arguments);
Reply run_place(Console& console, Arguments& arguments);
Reply run_insert(Console& console, Arguments& arguments);
Reply run_mate(Console& console, Arguments& arguments);
Reply run_unmate(Console& console, Arguments& arguments);
Reply run_pattern(Console& console, Arguments& arguments);
Reply run_fit(Console& console, Arguments& arguments);
Reply run_stack(Console& console, Arguments& arguments);
Reply run_fasten(Console& console, Arguments& arguments);
Reply run_freedoms(Console& console, Arguments& arguments);
Reply run_move(Console& console, Arguments& arguments);
Reply run_rotate(Console& console, Arguments& arguments);
Reply run_drag(Console& console, Arguments& arguments);
Reply run_way(Console& console, Arguments& arguments);
Reply run_snap(Console& console, Arguments& arguments);
Reply run_where(Console& console, Arguments& arguments);
Reply run_recognise(Console& console, Arguments& arguments);
Reply run_sequence(Console& console, Arguments& arguments);
Reply run_unit(Console& console, Arguments& arguments);
Reply run_save_unit(Console& console, Arguments& arguments);
Reply run_insert_unit(Console& console, Arguments& arguments);
Reply run_diff(Console& console, Arguments& arguments);
Reply run_remove(Console& console, Arguments& arguments);
Reply run_ground(Console& console, Arguments& arguments);
Reply run_mode(Console& console, Arguments& arguments);
Reply run_tolerance(Console& console, Arguments& arguments);
Reply run_undo(Console& console, Arguments& arguments);
Reply run_redo(Console& console, Arguments& arguments);
Reply run_list(Console& console, Arguments& arguments);
Reply run_show(Console& console, Arguments& arguments);
Reply run_bom(Console& console, Arguments& arguments);
Reply run_check(Console& console, Arguments& arguments);
Reply run_role(Console& console, Arguments& arguments);
Reply run_force(Console& console, Arguments& arguments);
Reply run_load(Console& console, Arguments& arguments);
Reply run_point(Console& console, Arguments& arguments);
Reply run_accuracy(Console& console, Arguments& arguments);
Reply run_limit(Console& console, Arguments& arguments);
Reply run_design(Console& console, Arguments& arguments);
Reply run_analyse(Console& console, Arguments& arguments);
Reply run_rules(Console& console, Arguments& arguments);
Reply run_export(Console& console, Arguments& arguments);
Reply run_history(Console& console, Arguments& arguments);
Reply run_expect(Console& console, Arguments& arguments);
Reply run_help(Console& console, Arguments& arguments);
Reply run_quit(Console& console, Arguments& arguments);

}  // namespace dowel::tools
