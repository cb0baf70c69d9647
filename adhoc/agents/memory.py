"""A robot's memory: what it has perceived, what it was told, what it did (the paper's H)."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from adhoc.agents import communication
from adhoc.agents.dialects.listening import Listener
from adhoc.agents.hearsay import Hearsay
from adhoc.agents.news import News
from adhoc.core.geometry import planar_distance
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.plans import Event
from adhoc.core.values import ObjectRecord, Observation, RoomRecord
from adhoc.houses.house import FLOOR
from adhoc.perception.perception import Perception, PerceptionSettings, Sighting
from adhoc.prompting.fair_share import without_crowding
from adhoc.tasks.task import Task


class Memory:
    """Everything one robot knows, bounded in size so that a step costs the same at step 500 as at step 1.

    Args:
        me: The robot's name.
        task: Judges which objects need attention.
        settings: Of the robot's perception.
        messages_kept: How many messages are kept, sent ones among them. The paper keeps all; once there are
            more, the earliest fifth goes at once, so that those who read the latest see the same beginning;
            of a robot that talks without end, all but an equal share.
        events_kept: How many of its own events are kept.
        looks: Frames in which an object must be judged to need attention before it does: the first glimpse
            of a half-seen shelf is often wrong.
        claims_kept: Steps after which a silent teammate's claim on an object is void: it may be out of order.
    """

    def __init__(
        self,
        me: str,
        task: Task,
        settings: PerceptionSettings | None = None,
        messages_kept: int = 1000,
        events_kept: int = 30,
        claims_kept: int = 150,
        looks: int = 2,
    ) -> None:
        self.me = me
        self.perception = Perception(settings or PerceptionSettings())
        self.teammates: dict[str, TeammateView] = {}
        self.messages: list[Message] = []
        self.events: deque[Event] = deque(maxlen=events_kept)
        self._messages_kept = messages_kept
        self._claims_kept = claims_kept
        self._looks = looks
        self._suspected: Counter[str] = Counter()
        self._task = task
        self._hearsay = Hearsay()
        self._listener = Listener()
        self._needs: dict[str, bool] = {}
        self._records: dict[str, tuple[ObjectRecord, ObjectRecord]] = {}
        self._explored: set[str] = set()
        self._probabilities: dict[str, Mapping[str, float]] = {}
        self._step = 0
        self.held: ObjectRecord | None = None
        """What is known of the object in the hand."""

    def observe(self, observation: Observation) -> tuple[Sighting, News]:
        """Take in one observation; what is new in it, judged by the task."""
        self._step = observation.step
        placed = self._grasp(observation)
        sighting = self.perception.observe(observation)
        settled = [gone for gone in sighting.gone if self._needs.pop(gone, False)]
        misplaced = []
        to_judge = dict.fromkeys((*([placed] if placed else []), *self._to_judge(sighting)))
        known = self.perception.objects
        self._task.anticipate([known[object_id] for object_id in to_judge if object_id in known])
        for object_id in to_judge:
            before, after = self._needs.get(object_id), self._judge(object_id)
            if after and not before:
                misplaced.append(object_id)
            elif before and after is False:
                settled.append(object_id)
        receptacles = tuple(name for name in sighting.new if self.perception.objects[name].is_receptacle)
        return sighting, News(
            tuple(misplaced),
            tuple(settled),
            receptacles,
            self._newly_explored(),
            placed=(placed,) if placed else (),
        )

    def hear(self, inbox: Sequence[Message]) -> News:
        """Take in messages: teammates' states, detections and explored rooms, in any known dialect."""
        told: list[str] = []
        settled: list[str] = []
        stopped: list[str] = []
        for message in self.understand(inbox):
            if message.kind is MessageKind.TEAM:
                continue
            self._keep(message)
            view = self.teammates.get(message.sender) or TeammateView(message.sender)
            updated = communication.read_view(view, message)
            self.teammates[message.sender] = updated
            if updated.stopped and not view.stopped:
                stopped.append(message.sender)
            for record in self._hearsay.objects(message):
                before = self._needs.get(record.id, False)
                self._tell(record)
                if record.misplaced is not None and record.misplaced != before:
                    (told if record.misplaced else settled).append(record.id)
            for room in self._hearsay.explored_rooms(message):
                self.perception.tell_explored(room, message.sender)
        return News(settled=tuple(settled), stopped=tuple(stopped), told=tuple(told))

    def understand(self, messages: Iterable[Message]) -> tuple[Message, ...]:
        """The messages in the library's own format, as far as their dialect is known (see `Listener`)."""
        return self._listener.understand(messages)

    def remember_sent(self, messages: Iterable[Message]) -> None:
        """Remember messages of this robot's own: the paper's M is all that it has sent and received."""
        for message in messages:
            if message.kind is not MessageKind.TEAM:
                self._keep(replace(message, sender=self.me, step=self._step))

    def note(self, text: str) -> None:
        """Remember an event of this robot's own."""
        self.events.append(Event(self._step, text))

    def record(self, object_id: str) -> ObjectRecord | None:
        """What is known of one object, with the judgement whether it is misplaced; None if nothing is."""
        if self.held is not None and self.held.id == object_id:
            return self.held
        known = self.perception.objects.get(object_id)
        if known is None:
            return None
        needed = self._needs.get(object_id)
        cached = self._records.get(object_id)
        if cached is None or cached[0] is not known or cached[1].misplaced is not needed:
            cached = self._records[object_id] = (known, replace(known, misplaced=needed))
        return cached[1]

    def attention(self) -> Iterator[ObjectRecord]:
        """The objects that need attention, in the order in which they were found."""
        for object_id, needed in self._needs.items():
            record = self.record(object_id) if needed else None
            if record is not None:
                yield record

    def receptacles(self) -> Iterator[ObjectRecord]:
        """The known receptacles that are furniture."""
        for record in self.perception.objects.values():
            if record.is_receptacle and not record.is_pickupable:
                yield record

    def places_near(self, position: Sequence[float]) -> list[tuple[ObjectRecord, str | None]]:
        """The known receptacles with their rooms' inferred types, nearest to `position` first."""
        ordered = sorted(
            self.receptacles(), key=lambda it: (planar_distance(it.position, tuple(position)), it.id)
        )
        return [(receptacle, self.room_type(receptacle.room)) for receptacle in ordered]

    def fitting(self, receptacles: Iterable[str], records: Iterable[ObjectRecord]) -> list[ObjectRecord]:
        """Those of the receptacles where at least one of the objects belongs."""
        needy = list(records)
        known = [record for record in map(self.record, receptacles) if record is not None]
        return [
            receptacle
            for receptacle in known
            if any(
                self._task.is_place_for(record, receptacle, self.room_type(receptacle.room))
                for record in needy
            )
        ]

    def room_type(self, room: str | None) -> str | None:
        """The inferred type of a room; None while undecided."""
        known = self.perception.rooms.get(room) if room is not None else None
        return None if known is None else known.room_type

    def rooms_near(self, position: Sequence[float]) -> list[RoomRecord]:
        """The known rooms, nearest to `position` first."""
        return sorted(
            self.perception.rooms.values(),
            key=lambda it: (planar_distance(it.position, tuple(position)), it.id),
        )

    def settle(self, object_id: str) -> None:
        """The object needs no attention any more, e.g. because this robot has put it right."""
        if object_id in self._needs:
            self._needs[object_id] = False

    def lose(self, object_id: str) -> None:
        """The object is not where it was believed to be, and nobody knows where."""
        self._needs.pop(object_id, None)
        self.perception.forget(object_id)

    def claimed(self, object_id: str) -> str | None:
        """The teammate that holds the object or whose current sub-task is about it, or None."""
        for view in self.teammates.values():
            if view.last_heard < self._step - self._claims_kept:
                continue
            if view.holding == object_id:
                return view.name
            if not view.stopped and view.sub_task is not None and object_id in view.sub_task.args:
                return view.name
        return None

    def teammates_at(self) -> tuple[tuple[float, float], ...]:
        """Where the teammates that still work are, as far as they have told."""
        views = self.teammates.values()
        return tuple(view.position for view in views if view.position is not None and not view.stopped)

    def explored_rooms(self) -> list[str]:
        """Ids of the rooms that are explored, by this robot or, as it was told, by others."""
        return sorted(room.id for room in self.perception.rooms.values() if room.explored)

    def _keep(self, message: Message) -> None:
        if len(self.messages) >= self._messages_kept:
            fair = without_crowding(self.messages, self.me, self._messages_kept - 1)
            earliest = max(1, self._messages_kept // 5) if len(fair) == len(self.messages) else 0
            self.messages = fair[earliest:]
        self.messages.append(message)

    def _grasp(self, observation: Observation) -> str | None:
        """Keep track of the hand: what is held is nowhere else, what was put down is where it was put.

        Returns the id of an object that has just left the hand.
        """
        before, held = self.held, observation.held
        if held is not None:
            if before is None or before.id != held:
                self.held = self.record(held)
                self.lose(held)
            return None
        self.held = None
        if before is None:
            return None
        self.perception.tell_object(self._put_record(before, observation))
        return before.id

    def _put_record(self, held: ObjectRecord, observation: Observation) -> ObjectRecord:
        """Where an object is after it left the hand: in the receptacle that was named, or on the floor."""
        result = observation.last_result
        target = self.perception.objects.get(result.action.target or "") if result is not None else None
        if target is None:
            place = (observation.pose.x, observation.pose.y, 0.0)
            room = self.perception.map.room_at(*place[:2])
            receptacle, category = FLOOR, FLOOR
        else:
            place, room = target.position, target.room
            receptacle, category = target.id, target.category
        return replace(
            held,
            position=place,
            room=room,
            receptacle=receptacle,
            receptacle_category=category,
            last_seen=observation.step,
            source="me",
        )

    def _to_judge(self, sighting: Sighting) -> Iterable[str]:
        """New and moved objects, undecided ones in view, and all in a room whose type looks different now."""
        changed = dict.fromkeys((*sighting.new, *sighting.moved))
        changed.update(
            dict.fromkeys(
                name for name in sighting.visible if name not in self._needs or name in self._suspected
            )
        )
        for room in self.perception.rooms:
            probabilities = self.perception.room_probabilities(room)
            if self._probabilities.get(room) != probabilities:
                self._probabilities[room] = dict(probabilities)
                changed.update(
                    dict.fromkeys(it.id for it in self.perception.objects.values() if it.room == room)
                )
        return changed

    def _judge(self, object_id: str) -> bool | None:
        record = self.perception.objects.get(object_id)
        if record is None:
            return None
        probabilities = {} if record.room is None else self.perception.room_probabilities(record.room)
        judgement = self._task.judge(record, probabilities)
        if judgement is None:
            return self._needs.get(object_id)
        if judgement and not self._needs.get(object_id):
            self._suspected[object_id] += 1
            if self._suspected[object_id] < self._looks:
                return None
        self._suspected.pop(object_id, None)
        self._needs[object_id] = judgement
        return judgement

    def _tell(self, record: ObjectRecord) -> None:
        self.perception.tell_object(record)
        if record.misplaced is not None:
            self._needs[record.id] = record.misplaced

    def _newly_explored(self) -> tuple[str, ...]:
        mine = {
            room.id for room in self.perception.rooms.values() if room.explored and room.explored_by == "me"
        }
        new = tuple(sorted(mine - self._explored))
        self._explored |= mine
        return new
