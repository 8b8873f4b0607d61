"""The part of a glTF file that holds arrays, for the scenes that benchmarks write."""

import base64
import struct


def packed(arrays):
    """`buffers`, `bufferViews` and `accessors` of a glTF: accessor i is arrays[i], a list of points (3 numbers each) or of indices."""
    data, views, accessors = b"", [], []
    for i, values in enumerate(arrays):
        if isinstance(values[0], int):
            more = struct.pack(f"<{len(values)}I", *values)
            accessor = {"componentType": 5125, "type": "SCALAR"}
        else:
            more = struct.pack(f"<{3 * len(values)}f", *(x for point in values for x in point))
            accessor = {"componentType": 5126, "type": "VEC3", "min": [min(axis) for axis in zip(*values)],
                        "max": [max(axis) for axis in zip(*values)]}
        accessors.append({"bufferView": i, "count": len(values), **accessor})
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(more)})
        data += more
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {"buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views, "accessors": accessors}
