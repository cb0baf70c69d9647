from adhoc.core.values import ObjectRecord
from adhoc.perception.scene_graph import HOUSE, SceneGraph


def record(
    name: str, category: str, receptacle: str | None = None, room: str | None = "room|2"
) -> ObjectRecord:
    return ObjectRecord(name, category, (0.0, 0.0, 0.0), room, receptacle)


def built() -> SceneGraph:
    graph = SceneGraph()
    graph.set_room("room|2", "Kitchen")
    graph.place(record("table", "DiningTable"))
    graph.place(record("bowl", "Bowl", "table"))
    graph.place(record("egg", "Egg", "bowl"))
    return graph


def test_the_tree_as_text():
    assert built().as_text() == (
        "house\n  room|2 (Kitchen)\n    table (DiningTable)\n      bowl (Bowl)\n        egg (Egg)"
    )


def test_an_object_hangs_below_one_thing_only():
    graph = built()
    graph.set_room("room|3")
    graph.place(record("egg", "Egg", "Floor", "room|3"))
    assert graph.parent("egg") == "room|3"
    assert graph.children("bowl") == ()
    assert "room|3 (type unknown)" in graph.as_text()


def test_unknown_places_hang_below_the_house():
    graph = built()
    graph.place(record("mug", "Mug", None, None))
    graph.place(record("cup", "Cup", "a shelf nobody saw", "a room nobody saw"))
    assert graph.parent("mug") == graph.parent("cup") == HOUSE


def test_removing_a_holder_keeps_what_it_held():
    graph = built()
    graph.remove("bowl")
    assert "bowl" not in graph
    assert graph.parent("egg") == "table"
    graph.remove("bowl")


def test_no_circles():
    graph = built()
    graph.place(record("bowl", "Bowl", "egg"))
    assert graph.parent("bowl") == "room|2"
    assert graph.parent("egg") == "bowl"
