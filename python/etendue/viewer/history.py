"""What was, so that every change can be undone and done again."""

from __future__ import annotations

from typing import Generic, TypeVar

State = TypeVar("State")

_LONGEST = 1000


class History(Generic[State]):
    """A line of states with a place on it. Changes of one gesture, such as one drag, are one step."""

    def __init__(self, state: State) -> None:
        self._states = [state]
        self._place = 0
        self._gesture: object = None

    @property
    def state(self) -> State:
        """The present."""
        return self._states[self._place]

    def push(self, state: State, gesture: object = None) -> None:
        """A new present, instead of all that was undone; in place of the last one where the gesture goes on."""
        del self._states[self._place + 1 :]
        if gesture is not None and gesture == self._gesture:
            self._states[-1] = state
        else:
            self._states.append(state)
        del self._states[:-_LONGEST]
        self._place = len(self._states) - 1
        self._gesture = gesture

    def end_gesture(self) -> None:
        """What comes next is a step of its own."""
        self._gesture = None

    @property
    def can_undo(self) -> bool:
        """Whether there is something before the present."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was undone."""
        return self._place + 1 < len(self._states)

    def undo(self) -> State:
        """The state before, if there is one."""
        self._place = max(self._place - 1, 0)
        self._gesture = None
        return self.state

    def redo(self) -> State:
        """The state that was undone last, if there is one."""
        self._place = min(self._place + 1, len(self._states) - 1)
        self._gesture = None
        return self.state
