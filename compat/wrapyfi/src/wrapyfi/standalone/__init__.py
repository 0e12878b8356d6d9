"""Programs by themselves: `python -m wrapyfi.standalone.zeromq_proxy_broker`."""
