# SPDX-License-Identifier: BSD-3-Clause
"""Rosbags with a depth image, its camera_info and /ground_truth/pose (geometry_msgs/PoseStamped in the optical frame), as
scene_to_bag, the simulator and a motion capture beside the camera write them.

A bag becomes a scene folder in BOP's format, which the scoring and the other trackers read; frame k is the k-th image.
Our own tracker runs on the bag itself (track_bag), with its tf, joints and grasps.
"""
import json

import numpy as np

from . import EvaluationError
from .object_files import read_object
from .poses import pose, rotation_from_quaternion
from .scenes import Scene

TRUTH_TOPIC = "/ground_truth/pose"
SAME_STAMP_NS = 1_000_000
FLOAT_UNIT_M = 1e-4  # of 32FC1 images as 16-bit pictures


def is_bag(path):
    return path.is_file() and path.suffix == ".bag"


def _open(path):
    try:
        import rosbag
    except ImportError as error:
        raise EvaluationError(f"{path}: reading bags needs python3-rosbag ({error})") from error
    try:
        return rosbag.Bag(str(path))
    except rosbag.ROSBagUnindexedException as error:
        raise EvaluationError(f"{path} has no index (its recording was cut off): rosbag reindex mends that") from error
    except (rosbag.ROSBagException, OSError) as error:
        raise EvaluationError(f"cannot read {path} as a rosbag: {error}") from error


def choose_image_topic(topics, path):
    """topics: of type sensor_msgs/Image. The only one, or the only one that calls itself depth."""
    depth = topics if len(topics) == 1 else [topic for topic in topics if "depth" in topic]
    if len(depth) != 1:
        raise EvaluationError(f"{path} has {len(depth)} depth images; its image topics: {', '.join(topics) or 'none'}")
    return depth[0]


def _pixels(message, where):
    """(16-bit counts, metres per count)"""
    kinds = {"16UC1": ("u2", 1e-3), "mono16": ("u2", 1e-3), "32FC1": ("f4", FLOAT_UNIT_M)}
    if message.encoding not in kinds:
        raise EvaluationError(f"{where}: the encoding {message.encoding} is no depth (16UC1, mono16, 32FC1)")
    kind, unit = kinds[message.encoding]
    kind = np.dtype((">" if message.is_bigendian else "<") + kind)
    if message.step < message.width * kind.itemsize or len(message.data) < message.step * message.height:
        raise EvaluationError(f"{where}: the image is shorter than its header says")
    rows = np.frombuffer(message.data, np.uint8)[:message.step * message.height].reshape(message.height, message.step)
    values = np.ascontiguousarray(rows[:, :message.width * kind.itemsize]).view(kind)
    if kind.kind == "f":
        metres = np.nan_to_num(values.astype(float), nan=0.0, posinf=0.0, neginf=0.0)
        values = np.clip(np.round(metres / unit), 0, None)
        values[values > 65535] = 0
    return values.astype(np.uint16), unit


def _truth(message):
    p, q = message.pose.position, message.pose.orientation
    return pose(rotation_from_quaternion([q.w, q.x, q.y, q.z]), np.array([p.x, p.y, p.z]))


def _near(stamps, values, stamp_ns):
    """The value of that stamp (to the millisecond), or None."""
    k = int(np.searchsorted(stamps, stamp_ns - SAME_STAMP_NS))
    return values[k] if k < len(stamps) and stamps[k] <= stamp_ns + SAME_STAMP_NS else None


def _newest(stamps, values, stamp_ns):
    return values[max(0, int(np.searchsorted(stamps, stamp_ns, side="right")) - 1)]


def _by_stamp(bag, topic, read):
    entries = sorted(((m.header.stamp.to_nsec(), read(m)) for _, m, _ in bag.read_messages(topic)), key=lambda e: e[0])
    return [stamp for stamp, _ in entries], [value for _, value in entries]


def _convert_images(bag, path, folder):
    """({frame: camera}, {frame: [truth]})"""
    from PIL import Image

    kinds = bag.get_type_and_topic_info().topics
    topic = choose_image_topic(sorted(name for name, kind in kinds.items() if kind.msg_type == "sensor_msgs/Image"), path)
    info_stamps, intrinsics = _by_stamp(bag, topic.rsplit("/", 1)[0] + "/camera_info", lambda m: list(m.K))
    truth_stamps, truths = _by_stamp(bag, TRUTH_TOPIC, _truth)
    if not intrinsics:
        raise EvaluationError(f"{path} has no camera_info beside {topic}")
    if not truths:
        raise EvaluationError(f"{path} has no ground truth on {TRUTH_TOPIC}")
    (folder / "depth").mkdir(parents=True, exist_ok=True)
    cameras, entries, first = {}, {}, None
    for k, (_, message, _) in enumerate(bag.read_messages(topic)):
        stamp = message.header.stamp.to_nsec()
        first = stamp if first is None else first
        counts, unit = _pixels(message, f"{path}, image {k}")
        Image.fromarray(counts).save(folder / "depth" / f"{k:06d}.png")
        cameras[k] = {"cam_K": _newest(info_stamps, intrinsics, stamp), "depth_scale": 1e3 * unit,
                      "timestamp": 1e-9 * (stamp - first)}
        truth = _near(truth_stamps, truths, stamp)
        if truth is not None:
            entries[k] = [{"obj_id": 1, "cam_R_m2c": truth[:3, :3].ravel().tolist(), "cam_t_m2c": (1e3 * truth[:3, 3]).tolist()}]
    return cameras, entries


def convert(path, folder):
    """Writes scene_camera.json, scene_gt.json and depth/ of the bag."""
    with _open(path) as bag:
        cameras, entries = _convert_images(bag, path, folder)
    (folder / "scene_camera.json").write_text(json.dumps(cameras), encoding="utf-8")
    (folder / "scene_gt.json").write_text(json.dumps(entries), encoding="utf-8")


def scene_of(path, object_file, work_folder):
    """object_file: None = NAME.yaml beside NAME.bag."""
    object_file = object_file or path.with_suffix(".yaml")
    if not object_file.is_file():
        raise EvaluationError(f"{path}: which object? Name its YAML or mesh with --object, or put it beside the bag as "
                              f"{object_file.name}")
    folder = work_folder / "bags" / path.parent.name / path.stem
    convert(path, folder)
    mesh, scale, models_info = read_object(object_file, folder)
    return Scene(f"{path.parent.name}/{path.stem}", folder, mesh=mesh, mesh_scale=scale, models_info=models_info,
                 data_set=path.parent.name, bag=path.resolve(), object_file=object_file.resolve())
