"""The service of sounds: a text is asked, the answer has the message."""

import hashlib

from genpy.dynamic import generate_dynamic

from wrapyfi_ros_interfaces import msg

NAME = "wrapyfi_ros_interfaces/ROSAudioService"


def half(word: str, text: str) -> type:
    """Request or response."""
    name = f"{NAME}{word}"
    rule = "=" * 80
    full = (
        f"{text}\n{rule}\nMSG: {msg.NAME}\n{msg.FIELDS}\n{rule}\nMSG: std_msgs/Header\n{msg.HEADER}"
    )
    made: type = generate_dynamic(name, full if "/" in text else text)[name]
    return made


class ROSAudioService:
    _type = NAME
    _request_class = half("Request", "string request\n")
    _response_class = half("Response", f"{msg.NAME} response\n")
    _md5sum = hashlib.md5(
        f"string request{msg.ROSAudioMessage._md5sum} response".encode()
    ).hexdigest()
