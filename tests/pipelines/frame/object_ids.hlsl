uint PSMain([[vk::location(3)]] nointerpolation uint object_index : OBJECT_INDEX) : SV_Target0 { return object_index + 1; }
