"""The pointer in the picture: a click that does not drag picks; with the shift key what is there is dragged."""

from __future__ import annotations

import numpy as np
from vtkmodules.vtkInteractionStyle import vtkInteractorStyleUser

from . import moving


class Pointer:
    """What a `Window` does by the mouse."""

    def _listen(self) -> None:
        self._dragged, self._pressed = "", (0, 0)  # path of what is dragged; where the button went down, pixels
        self.interactor = self.view.plotter.iren.interactor
        for event, react in (("LeftButtonPressEvent", self._press), ("MouseMoveEvent", self._drag),
                             ("LeftButtonReleaseEvent", self._drop)):
            self.interactor.AddObserver(event, react, 1.0)  # before the style, which moves the camera
        self.view.plotter.iren.add_observer("LeftButtonReleaseEvent", self._release)  # of the style

    def _press(self, *_) -> None:
        self._pressed = self.interactor.GetEventPosition()
        if self.state.mode == "case" and self.interactor.GetShiftKey():
            path = self.view.grab(*self._pressed)
            if moving.owner(self.document, path):
                self._dragged, self._style = path, self.interactor.GetInteractorStyle()
                self.interactor.SetInteractorStyle(vtkInteractorStyleUser())  # one that keeps the camera

    def _drag(self, *_) -> None:
        if self._dragged:
            self.view.drag(*self.interactor.GetEventPosition(), self._dragged)
            self._push()

    def _drop(self, *_) -> None:
        if not self._dragged:
            return
        path, self._dragged = self._dragged, ""
        self.interactor.SetInteractorStyle(self._style)
        shift, grid = self.view.drag(*self.interactor.GetEventPosition(), path), moving.grid_of(self.view.size)
        with self.state:
            self.state.selected = path
            self._edit(lambda: moving.move(self.document, path, shift, grid))

    def _release(self, *_) -> None:
        at = self.interactor.GetEventPosition()
        if self.state.mode == "case" and np.abs(np.subtract(at, self._pressed)).max() <= 2:
            path = self.view.pick(*at)
            if path and self.document.get(path) is not None:
                with self.state:
                    self.select(path)
