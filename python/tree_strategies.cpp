// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "bindings.hpp"

using cv::Mat;
using cv::stereo::TreeState;
using cv::stereo::TreeStrategy;

namespace {

thread_local int rules = 0; // that this thread is in

//! What a rule in Python needs; the matcher calls it without the interpreter's lock, from any thread.
struct InRule
{
    InRule() { ++rules; }
    ~InRule() { --rules; }
    py::gil_scoped_acquire acquire;
};

//! Edges that come from Python; message: if they are none
std::vector<int> edgesOf(const py::object& object, const char* message)
{
    if (!py::isinstance<py::array>(object))
        throw py::type_error(message);
    const py::array array = py::reinterpret_borrow<py::array>(object);
    const char kind = array.dtype().kind();
    if (array.ndim() != 1 || (kind != 'i' && kind != 'u'))
        throw py::type_error(message);
    const py::array_t<int64_t, py::array::c_style | py::array::forcecast> numbers(array);
    std::vector<int> edges;
    for (py::ssize_t i = 0; i < numbers.size(); ++i)
        edges.push_back(cv::saturate_cast<int>(numbers.data()[i])); // what is out of range is no edge either
    return edges;
}

//! A strategy written in Python
class PythonStrategy : public TreeStrategy
{
public:
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        const InRule rule;
        const py::function override = py::get_override(static_cast<const TreeStrategy*>(this), "orderEdges");
        if (!override)
            return TreeStrategy::orderEdges(weights, edges);
        edges = edgesOf(override(readOnly(toPython(weights.clone())), toPython(edges)),
                        "orderEdges() must return integers in one dimension");
    }

    bool mayJoin(int weight, const TreeState& a, const TreeState& b) const CV_OVERRIDE
    {
        const InRule rule;
        const py::function override = py::get_override(static_cast<const TreeStrategy*>(this), "mayJoin");
        if (!override)
        {
            PyErr_SetString(PyExc_NotImplementedError, "a TreeStrategy must define mayJoin()");
            throw py::error_already_set();
        }
        return toBool(override(weight, a, b), "mayJoin");
    }

    bool ordersByWeight() const CV_OVERRIDE { return answer("ordersByWeight", TreeStrategy::ordersByWeight()); }
    bool unitesIntervals() const CV_OVERRIDE { return answer("unitesIntervals", TreeStrategy::unitesIntervals()); }
    bool linksTrees() const CV_OVERRIDE { return answer("linksTrees", TreeStrategy::linksTrees()); }

    cv::String getDefaultName() const CV_OVERRIDE
    {
        const InRule rule;
        const py::function override = py::get_override(static_cast<const TreeStrategy*>(this), "getDefaultName");
        if (override)
        {
            const py::object name = override();
            if (!py::isinstance<py::str>(name))
                throw py::type_error("getDefaultName() must return a str");
            return name.cast<std::string>();
        }
        return py::type::of(py::cast(static_cast<const TreeStrategy*>(this))).attr("__name__").cast<std::string>();
    }

private:
    bool answer(const char* name, bool byDefault) const
    {
        const InRule rule;
        const py::function override = py::get_override(static_cast<const TreeStrategy*>(this), name);
        return override ? toBool(override(), name) : byDefault;
    }

    static bool toBool(const py::object& answered, const char* name)
    {
        py::detail::make_caster<bool> bool_;
        if (answered.is_none() || !bool_.load(answered, true)) // None is a forgotten return
            throw py::type_error(std::string(name) + "() must return a bool");
        return py::detail::cast_op<bool>(bool_);
    }
};

//! Rule 1 of a strategy of the library, for Python
py::array_t<int> orderEdges(const TreeStrategy& self, const py::array& weightsArray, const py::object& edgesArray)
{
    std::vector<py::array> kept;
    const Mat weights = toMat(weightsArray, "weights", kept);
    if (weights.type() != CV_8UC2 || !weights.isContinuous())
        throw py::value_error("weights must be a contiguous array of uint8 in two channels");
    std::vector<int> edges = edgesOf(edgesArray, "edges must be integers in one dimension");
    for (const int edge : edges)
        if (edge < 0 || (size_t)edge >= 2 * weights.total())
            throw py::value_error("edges must be in 0 .. 2 * height * width - 1, not " + std::to_string(edge));
    // Of a strategy in Python that calls super().orderEdges(), this is the default.
    if (dynamic_cast<const PythonStrategy*>(&self))
        self.TreeStrategy::orderEdges(weights, edges);
    else
        self.orderEdges(weights, edges);
    return toPython(edges);
}

} // namespace

bool isInRule() { return rules > 0; }

bool isPythonStrategy(const cv::Ptr<TreeStrategy>& strategy)
{
    return dynamic_cast<const PythonStrategy*>(strategy.get()) != nullptr;
}

cv::Ptr<TreeStrategy> keptStrategy(const py::object& object)
{
    if (object.is_none())
        return cv::Ptr<TreeStrategy>();
    if (!py::isinstance<TreeStrategy>(object))
        throw py::type_error("strategy must be a TreeStrategy");
    const cv::Ptr<TreeStrategy> strategy = object.cast<cv::Ptr<TreeStrategy>>();
    if (!isPythonStrategy(strategy))
        return strategy;
    py::object* const kept = new py::object(object);
    return cv::Ptr<TreeStrategy>(strategy.get(), [kept](TreeStrategy*) {
        const py::gil_scoped_acquire acquire;
        delete kept;
    });
}

void addTreeStrategies(py::module_& module)
{
    py::class_<TreeState> state(module, "TreeState", "A tree under construction, as mayJoin() sees it.");
    setPackage(state);
    state.def_readonly("size", &TreeState::size, "Number of pixels, >= 1")
        .def_readonly("maxWeight", &TreeState::maxWeight,
                      "The largest weight of the edges inside the tree, in intensity levels; 0 for a single pixel");

    py::class_<TreeStrategy, PythonStrategy, cv::Ptr<TreeStrategy>> strategy(module, "TreeStrategy", R"doc(
Rule 1 and Rule 2 of the spanning trees of a layer, section 3.2 of the paper.

The edges of the layer's graph are tried one after another, in the order of Rule 1; an edge joins the two trees at its
ends if Rule 2 allows it. A class of your own derives from this one, and defines mayJoin() and, if edges are not to be
tried by ascending weight, orderEdges(). Both must be pure functions of their arguments. What they raise leaves
compute(). They must not use a matcher. It takes about a second per million edges and more.

    class ContourTree(hdpstereo.TreeStrategy):
        def mayJoin(self, weight, a, b):
            return weight <= 20)doc");
    setPackage(strategy);
    strategy.def(py::init_alias<>())
        .def("orderEdges", &orderEdges, py::arg("weights"), py::arg("edges"), R"doc(
Rule 1: returns the edges in the order in which they are tried. The default is ascending weight.

Edge 2 * i joins pixel i = y * width + x to its right neighbour, edge 2 * i + 1 to the one below.

weights: the largest absolute differences over the colour channels, 0 to 255, or for COST_CENSUS 9 / 8 of those of the
levels of grey images, rounded up, as they are matched, stretched and brightened: uint8 in two channels, of the layer's
size; weights.ravel()[e] is that of edge e. They are a copy, and read-only.
edges: the numbers of the edges that there are: int32 in one dimension.

Returns the same numbers in another order. compute() raises ValueError if one is added, removed or repeated.)doc")
        .def("mayJoin", &TreeStrategy::mayJoin, py::arg("weight"), py::arg("a"), py::arg("b"), R"doc(
Rule 2: whether an edge may join two trees.

weight: the edge's weight, 0 to 255.
a, b: the trees at its ends, see TreeState.)doc")
        .def("ordersByWeight", &TreeStrategy::ordersByWeight,
             "Whether Rule 1 is to try edges by ascending weight (False by default). If True, orderEdges() is not "
             "called, and mayJoin() is called from several threads.")
        .def("unitesIntervals", &TreeStrategy::unitesIntervals,
             "Whether a joined tree searches the hull of its parts' disparity intervals (True by default), or the "
             "interval of its larger part.")
        .def("linksTrees", &TreeStrategy::linksTrees,
             "Whether, without prediction, the trees that Rule 2 left apart are joined to one (True by default).")
        .def(
            "getDefaultName", [](const TreeStrategy& self) { return self.getDefaultName(); },
            "The name in files of a matcher; by default that of the class.");

    module.def("createMinimumSpanningTree", &cv::stereo::createMinimumSpanningTree,
               "Minimum spanning tree: edges by ascending weight, every edge may join.");
    module.def("createSegmentTree", &cv::stereo::createSegmentTree, py::arg("k") = 1200., R"doc(
Segment tree: edges by ascending weight; an edge joins two trees only if it is not much heavier than their own edges.

k: in intensity levels times pixels, finite, >= 0. The larger, the larger the segments.)doc");
    module.def("createRandomTree", &cv::stereo::createRandomTree, py::arg("seed") = 0, R"doc(
Random tree: edges in random order, every edge may join.

seed: of the shuffle, >= 0.)doc");
}
