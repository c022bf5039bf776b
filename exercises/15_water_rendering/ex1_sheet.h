// Exercise 15.1: a sheet of coloured water.
//
// A splash is full of thin sheets: two faces, a little water between them. Light that goes in is thrown to
// and fro between the faces, and on each crossing the water keeps some of it. The chapter's pane_reflection()
// is the sheet that keeps nothing. How much of the light comes back, goes through, stays?
#pragma once
#include <cmath>

#include "common/todo.h"

namespace water {

// What becomes of one unit of light.
struct Split {
    double reflected, through, absorbed;
};

// @param once  the part that one face throws back, 0 to 1; it is the same from both sides
// @param pass  the part that survives one crossing of the water, 0 to 1
inline Split sheet(double once, double pass) {
    // TODO(15.1): add up all bounces. Outside, the light meets `once`; what is inside then loses (1 - once)
    // at each face that it leaves through, and a factor `pass` on each crossing. The sums are geometric
    // series. A face that mirrors all of it is a case of its own. About 6 lines.
    (void)once, (void)pass;
    return {course::kTodo, course::kTodo, course::kTodo};
}

}  // namespace water
