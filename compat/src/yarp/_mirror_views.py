"""The views of a PolyDriver beyond those of boards, cameras and sensors."""

from __future__ import annotations

from typing import Any

from yarp._controller_view import ICartesianControl
from yarp._gaze_view import IGazeControl
from yarp._mirror import (
    ILLM,
    ILocalization2D,
    IMap2D,
    IOdometry2D,
    IRGBDSensor,
    ISimulatedWorld,
    ISpeechSynthesizer,
    ISpeechTranscription,
)
from yarp._navigation_view import INavigation2D
from yarp._place_view import IBattery, IFrameTransform


class MirrorViews:
    """The views that a PolyDriver has."""

    def _view(self, kind: Any, member: str) -> Any:
        raise NotImplementedError

    def viewICartesianControl(self) -> ICartesianControl | None:
        found: ICartesianControl | None = self._view(ICartesianControl, "solve")
        return found

    def viewIGazeControl(self) -> IGazeControl | None:
        found: IGazeControl | None = self._view(IGazeControl, "look_at_pixel")
        return found

    def viewILocalization2D(self) -> ILocalization2D | None:
        found: ILocalization2D | None = self._view(ILocalization2D, "localization_status")
        return found

    def viewIMap2D(self) -> IMap2D | None:
        found: IMap2D | None = self._view(IMap2D, "map_names")
        return found

    def viewINavigation2D(self) -> INavigation2D | None:
        found: INavigation2D | None = self._view(INavigation2D, "go")
        return found

    def viewIOdometry2D(self) -> IOdometry2D | None:
        found: IOdometry2D | None = self._view(IOdometry2D, "odometry")
        return found

    def viewISpeechSynthesizer(self) -> ISpeechSynthesizer | None:
        found: ISpeechSynthesizer | None = self._view(ISpeechSynthesizer, "synthesize")
        return found

    def viewISpeechTranscription(self) -> ISpeechTranscription | None:
        found: ISpeechTranscription | None = self._view(ISpeechTranscription, "transcribe")
        return found

    def viewIRGBDSensor(self) -> IRGBDSensor | None:
        found: IRGBDSensor | None = self._view(IRGBDSensor, "depth")
        return found

    def viewILLM(self) -> ILLM | None:
        found: ILLM | None = self._view(ILLM, "conversation")
        return found

    def viewISimulatedWorld(self) -> ISimulatedWorld | None:
        found: ISimulatedWorld | None = self._view(ISimulatedWorld, "make_box")
        return found

    def viewIBattery(self) -> IBattery | None:
        found: IBattery | None = self._view(IBattery, "charge")
        return found

    def viewIFrameTransform(self) -> IFrameTransform | None:
        found: IFrameTransform | None = self._view(IFrameTransform, "place")
        return found if self._view(IFrameTransform, "frames") is not None else None
