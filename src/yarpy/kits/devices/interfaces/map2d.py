"""Map2D: maps, and what has a name in them: places, areas, paths and objects.

Source: IMap2D of YARP 3.6 to 4.0 (objects and `reload_...`: 3.12.2 and later).
"""

from __future__ import annotations

from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.interfaces.place import Area, Path, Place, Thing
from yarpy.kits.devices.network.model import Interface, call
from yarpy.kits.thrift.kind import Nested


class Map2D(Interface):
    """The interface of a device that keeps maps."""

    NWS, NWC = "map2D_nws_yarp", "map2D_nwc_yarp"
    FAKE = "map2DStorage"
    VIEW = "IMap2D"

    @call("store_map_RPC", cpp="store_map")
    def store_map(self, grid: Nested[Grid]) -> None:
        """Keep a map under its name."""

    @call("get_map_RPC", cpp="get_map")
    def map(self, name: str) -> Nested[Grid]:
        """Return a map."""
        raise NotImplementedError

    @call("get_map_names_RPC", cpp="get_map_names")
    def map_names(self) -> list[str]:
        """Return the names of all maps."""
        raise NotImplementedError

    @call("remove_map_RPC", cpp="remove_map")
    def remove_map(self, name: str) -> None:
        """Forget a map."""

    @call("clear_all_maps_RPC", cpp="clearAllMaps")
    def clear_maps(self) -> None:
        """Forget all maps."""

    @call("clear_all_maps_temporary_flags_RPC", cpp="clearAllMapsTemporaryFlags")
    def clear_all_obstacles(self) -> None:
        """Forget the temporary obstacles in all maps."""

    @call("clear_map_temporary_flags_RPC", cpp="clearMapTemporaryFlags")
    def clear_obstacles(self, name: str) -> None:
        """Forget the temporary obstacles in a map."""

    @call("enable_maps_compression_RPC", cpp="enableMapsCompression")
    def compress_maps(self, enable: bool) -> None:
        """Send maps compressed, or not."""

    @call("store_location_RPC", cpp="storeLocation")
    def store_location(self, name: str, location: Nested[Place]) -> None:
        """Keep a place."""

    @call("get_location_RPC", cpp="getLocation")
    def location(self, name: str) -> Nested[Place]:
        """Return a place by its name."""
        raise NotImplementedError

    @call("get_locations_list_RPC", cpp="getLocationsList")
    def location_names(self) -> list[str]:
        """Return the names of all locations."""
        raise NotImplementedError

    @call("get_all_locations_RPC", cpp="getAllLocations")
    def locations(self) -> list[Place]:
        """Return all locations."""
        raise NotImplementedError

    @call("rename_location_RPC", cpp="renameLocation")
    def rename_location(self, name: str, new_name: str) -> None:
        """Give a place another name."""

    @call("delete_location_RPC", cpp="deleteLocation")
    def delete_location(self, name: str) -> None:
        """Forget a place."""

    @call("clear_all_locations_RPC", cpp="clearAllLocations")
    def clear_locations(self) -> None:
        """Forget all locations."""

    @call("store_area_RPC", cpp="storeArea")
    def store_area(self, name: str, area: Nested[Area]) -> None:
        """Keep an area."""

    @call("get_area_RPC", cpp="getArea")
    def area(self, name: str) -> Nested[Area]:
        """Return an area by its name."""
        raise NotImplementedError

    @call("get_areas_list_RPC", cpp="getAreasList")
    def area_names(self) -> list[str]:
        """Return the names of all areas."""
        raise NotImplementedError

    @call("get_all_areas_RPC", cpp="getAllAreas")
    def areas(self) -> list[Area]:
        """Return all areas."""
        raise NotImplementedError

    @call("rename_area_RPC", cpp="renameArea")
    def rename_area(self, name: str, new_name: str) -> None:
        """Give an area another name."""

    @call("delete_area_RPC", cpp="deleteArea")
    def delete_area(self, name: str) -> None:
        """Forget an area."""

    @call("clear_all_areas_RPC", cpp="clearAllAreas")
    def clear_areas(self) -> None:
        """Forget all areas."""

    @call("store_path_RPC", cpp="storePath")
    def store_path(self, name: str, path: Nested[Path]) -> None:
        """Keep a path."""

    @call("get_path_RPC", cpp="getPath")
    def path(self, name: str) -> Nested[Path]:
        """Return a path by its name."""
        raise NotImplementedError

    @call("get_paths_list_RPC", cpp="getPathsList")
    def path_names(self) -> list[str]:
        """Return the names of all paths."""
        raise NotImplementedError

    @call("get_all_paths_RPC", cpp="getAllPaths")
    def paths(self) -> list[Path]:
        """Return all paths."""
        raise NotImplementedError

    @call("rename_path_RPC", cpp="renamePath")
    def rename_path(self, name: str, new_name: str) -> None:
        """Give a path another name."""

    @call("delete_path_RPC", cpp="deletePath")
    def delete_path(self, name: str) -> None:
        """Forget a path."""

    @call("clear_all_paths_RPC", cpp="clearAllPaths")
    def clear_paths(self) -> None:
        """Forget all paths."""

    @call("store_object_RPC", cpp="storeObject")
    def store_object(self, name: str, thing: Nested[Thing]) -> None:
        """Keep an object."""

    @call("get_object_RPC", cpp="getObject")
    def object(self, name: str) -> Nested[Thing]:
        """Return an object by its name."""
        raise NotImplementedError

    @call("get_objects_list_RPC", cpp="getObjectsList")
    def object_names(self) -> list[str]:
        """Return the names of all objects."""
        raise NotImplementedError

    @call("get_all_objects_RPC", cpp="getAllObjects")
    def objects(self) -> list[Thing]:
        """Return all objects."""
        raise NotImplementedError

    @call("rename_object_RPC", cpp="renameObject")
    def rename_object(self, name: str, new_name: str) -> None:
        """Give an object another name."""

    @call("delete_object_RPC", cpp="deleteObject")
    def delete_object(self, name: str) -> None:
        """Forget an object."""

    @call("clear_all_objects_RPC", cpp="clearAllObjects")
    def clear_objects(self) -> None:
        """Forget all objects."""

    @call("save_maps_collection_RPC", cpp="saveMapsCollection")
    def save_maps(self, file: str) -> None:
        """Write all maps to a file of the server."""

    @call("load_maps_collection_RPC", cpp="loadMapsCollection")
    def load_maps(self, file: str) -> None:
        """Read them from a file of the server."""

    @call("save_locations_and_extras_RPC", cpp="saveLocationsAndExtras")
    def save_names(self, file: str) -> None:
        """Write all that has a name to a file of the server."""

    @call("load_locations_and_extras_RPC", cpp="loadLocationsAndExtras")
    def load_names(self, file: str) -> None:
        """Read it from a file of the server."""

    @call("load_map_from_disk_RPC", cpp="loadMapFromDisk")
    def load_map(self, file: str) -> None:
        """Read a map from a file of the server."""

    @call("save_map_to_disk_RPC", cpp="saveMapToDisk")
    def save_map(self, name: str, file: str) -> None:
        """Write a map to a file of the server."""

    @call("reload_maps_collection_RPC", cpp="reloadMapsCollection")
    def reload_maps(self) -> None:
        """Read the maps again that it began with."""

    @call("reload_locations_and_extras_RPC", cpp="reloadLocationsAndExtras")
    def reload_names(self) -> None:
        """Read again what had a name when it began."""
